// Declarations by name.
#include "generator/dsl/resources.h"

#include <algorithm>

#include <fmt/format.h>

namespace intaglio::dsl {
namespace {

// The index of the declaration of this name; appended if there is none.
template <typename Declaration>
int find_or_add(std::vector<Declaration>& declarations, Declaration declaration) {
    const auto found =
        std::find_if(declarations.begin(), declarations.end(),
                     [&](const Declaration& other) { return other.name == declaration.name; });
    if (found == declarations.end()) {
        declarations.push_back(std::move(declaration));
        return static_cast<int>(declarations.size()) - 1;
    }
    if (!(*found == declaration))
        Recorder::current().fail(input_error(
            "declared-twice",
            fmt::format("'{}' is declared twice, with different types, filters or comments",
                        declaration.name)));
    return static_cast<int>(found - declarations.begin());
}

}  // namespace

template <int Dimension>
Sampler<Dimension>::Sampler(std::string_view name, std::string_view comment, Filter filter,
                            std::string_view baked)
    : slot_(find_or_add(Recorder::current().module().samplers,
                        ir::Sampler{std::string(name), Dimension, std::string(comment), filter,
                                    std::string(baked)})) {}

template <int Dimension>
float4 Sampler<Dimension>::sample_level(Float<Dimension> at, float1 level, Place place) const {
    Recorder& recorder = Recorder::current();
    const float4 texel =
        float4::of(recorder.builder().sample(ir::Op::SampleLevel, slot_, {at.id(), level.id()}));
    recorder.locate(place);
    return texel;
}

template <int Dimension>
float4 Sampler<Dimension>::sample_grad(Float<Dimension> at, Float<Dimension> ddx_at,
                                       Float<Dimension> ddy_at, Place place) const {
    Recorder& recorder = Recorder::current();
    const float4 texel = float4::of(
        recorder.builder().sample(ir::Op::SampleGrad, slot_, {at.id(), ddx_at.id(), ddy_at.id()}));
    recorder.locate(place);
    return texel;
}

template <int Dimension>
float4 Sampler<Dimension>::sample(Float<Dimension> at, Place place) const {
    Recorder& recorder = Recorder::current();
    const float4 texel =
        float4::of(recorder.builder().sample(ir::Op::SampleImplicit, slot_, {at.id()}));
    recorder.locate(place);
    return texel;
}

template class Sampler<2>;
template class Sampler<3>;

ir::ValueId record_uniform(std::string_view name, ir::Type type, int count, int element,
                           std::string_view comment) {
    Recorder& recorder = Recorder::current();
    const int slot = find_or_add(recorder.module().uniforms,
                                 ir::Uniform{std::string(name), type, count, std::string(comment)});
    return recorder.builder().uniform(slot, element);
}

ir::ValueId record_input(std::string_view name, ir::Type type, ir::Semantic semantic) {
    Recorder& recorder = Recorder::current();
    const int slot =
        find_or_add(recorder.module().inputs, ir::Declaration{std::string(name), type, semantic});
    return recorder.builder().input(slot);
}

}  // namespace intaglio::dsl
