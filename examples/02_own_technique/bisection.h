// The row of a technique of one's own.
#pragma once

#include "generator/intaglio.h"

intaglio::dsl::Entry<intaglio::dsl::Search> bisection();
