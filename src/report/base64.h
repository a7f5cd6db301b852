// Bytes inside a text (RFC 4648, with padding).
#pragma once

#include <span>
#include <string>

namespace intaglio::report {

std::string base64(std::span<const unsigned char> bytes);

}  // namespace intaglio::report
