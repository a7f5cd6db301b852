// Names and hashes of cases.
#include "src/measure/case.h"

#include <fmt/format.h>

#include "generator/base/nearest.h"
#include "src/measure/hash.h"

namespace intaglio::measure {

std::string_view name_of(Arithmetic arithmetic) {
    switch (arithmetic) {
        case Arithmetic::Fp32: return "fp32";
        case Arithmetic::Fp24: return "fp24";
        case Arithmetic::Fp16: break;
    }
    return "fp16";
}

Result<Arithmetic> arithmetic_named(const std::string& name) {
    std::vector<std::string> names;
    for (Arithmetic arithmetic : {Arithmetic::Fp32, Arithmetic::Fp24, Arithmetic::Fp16}) {
        names.emplace_back(name_of(arithmetic));
        if (name == names.back()) return arithmetic;
    }
    return input_error("unknown-arithmetic", unknown_name_sentence("arithmetic", name, names));
}

std::string_view name_of(Maker maker) {
    switch (maker) {
        case Maker::Device: return "device";
        case Maker::Interpreter: return "interpreter";
        case Maker::Evaluator: break;
    }
    return "evaluator";
}

std::string content_hash(const MapSet& set) {
    Hash hash;
    for (const maps::Image* image : {&set.heights, &set.normal_height, &set.colour}) {
        hash.add(
            fmt::format("{} {} {} {};", image->width, image->height, image->channels, image->bits));
        hash.add({reinterpret_cast<const char*>(image->texels.data()),
                  image->texels.size() * sizeof(float)});
    }
    return hash.hex();
}

}  // namespace intaglio::measure
