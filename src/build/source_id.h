// Made by cmake/source_id.cmake from all code that shapes what a build writes.
#pragma once

namespace intaglio::build {

const char* source_id();

}  // namespace intaglio::build
