// Derived artifacts: front end, then optimiser or SPIRV-Cross.
#include "src/check/derive.h"

#include "src/check/cross.h"
#include "src/check/frontend.h"
#include "src/check/spirv.h"

namespace intaglio::check {

Result<SpirvWords> derive_spirv(const Source& source) {
    const Result<SpirvWords> words = to_spirv(source);
    if (!words) return words.error();
    return optimize_spirv(*words);
}

Result<std::string> derive_msl(const Source& source) {
    const Result<SpirvWords> words = to_spirv(source);
    if (!words) return words.error();
    return cross_to(*words, CrossTarget::Msl);
}

}  // namespace intaglio::check
