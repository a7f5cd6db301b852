// Everything a technique's author includes: the DSL, the parts of a surface and the catalogue they
// are listed in.
#pragma once

#include "generator/dsl/catalogue.h"
#include "generator/dsl/surface.h"
