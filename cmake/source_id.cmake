# Writes OUT with a hash of the files in LIST, by their places below ROOT and their contents: the function
# `const char* NAMESPACE::source_id()`, which HEADER declares.
file(READ "${LIST}" files)
list(SORT files)
set(all "")
foreach(file IN LISTS files)
  file(RELATIVE_PATH name "${ROOT}" "${file}")
  file(SHA256 "${file}" hash)
  string(APPEND all "${name} ${hash}\n")
endforeach()
string(SHA256 id "${all}")
string(SUBSTRING "${id}" 0 16 id)
file(WRITE "${OUT}" "// Made by source_id.cmake.
#include \"${HEADER}\"

namespace ${NAMESPACE} {
const char* source_id() { return \"${id}\"; }
}  // namespace ${NAMESPACE}
")
