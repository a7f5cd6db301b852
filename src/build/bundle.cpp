// Emitted, accepted, read: in this order, so that nothing is said of what no witness took.
#include "src/build/bundle.h"

#include <fmt/format.h>

#include "generator/ir/print.h"
#include "src/measure/hash.h"
#include "src/measure/named_metric.h"

namespace intaglio::build {
namespace {

constexpr ir::Stage stages[] = {ir::Stage::Vertex, ir::Stage::Pixel};

const Artifact& artifact_of(const Variant& variant, ir::Stage stage) {
    return stage == ir::Stage::Vertex ? variant.vertex : variant.pixel;
}

std::string bytes_of(const check::SpirvWords& words) {
    return {reinterpret_cast<const char*>(words.data()), words.size() * sizeof(words[0])};
}

Result<std::string> bytes_of(const StageFile& file, const Variant& variant,
                             const Accepted& accepted) {
    // Beside a text lies what its front end made of it.  The target `spirv` is optimised.
    if (file.kind == FileKind::Spirv && variant.target->derived_from.empty())
        return bytes_of(file.stage == ir::Stage::Vertex ? accepted.program->vertex
                                                        : accepted.program->pixel);
    Result<Product> product = product_of(
        variant, file.stage, file.kind == FileKind::Bytecode ? Form::Bytecode : Form::Shader);
    if (!product) return product.error();
    return std::move(product->bytes);
}

// Both stages of a surface say some things twice.
void add_notes(const Variant& variant, Bundle& bundle) {
    for (const ir::Stage stage : stages)
        for (const std::string& note : artifact_of(variant, stage).notes)
            if (std::find(bundle.notes.begin(), bundle.notes.end(), note) == bundle.notes.end())
                bundle.notes.push_back(note);
}

std::vector<plan::Figure> slots_of(const std::vector<d3d9::Shader>& shaders) {
    std::vector<plan::Figure> figures;
    for (const d3d9::Shader& shader : shaders) {
        if (!is_pixel(shader.profile)) continue;
        for (const auto& [metric, value] : measure::metrics_of(d3d9::count(shader)))
            figures.push_back(
                {std::string(metric), static_cast<double>(value), "Direct3D 9's charge"});
    }
    return figures;
}

Result<Variant> variant_of(const dsl::Catalogue& catalogue, const plan::Order& order) {
    if (dsl::pass_count(order.request.split) > 1)
        return input_error("order-split",
                           fmt::format("{} is drawn in several passes, which `intaglio build` does "
                                       "not write; `intaglio emit --split` does",
                                       order.name()));
    return make_variant(catalogue, order.request);
}

// Length first, so that no two lists of texts look alike.
class KeyText {
  public:
    void add(std::string_view text) {
        hash_.add(fmt::format("{}:", text.size()));
        hash_.add(text);
    }
    std::string hex() const { return hash_.hex(); }

  private:
    measure::Hash hash_;
};

}  // namespace

bool Bundle::operator==(const Bundle& other) const { return to_bytes(*this) == to_bytes(other); }

Result<Bundle> make_bundle(const dsl::Catalogue& catalogue, const plan::Order& order,
                           const BundleOptions& options) {
    const Result<Variant> variant = variant_of(catalogue, order);
    if (!variant) return variant.error();
    const Result<Accepted> accepted = accept_variant(*variant);
    if (!accepted) return accepted.error();
    Bundle bundle;
    bundle.witnesses = accepted->steps;
    if (options.judge) {
        Result<Judged> judged = judge_variant(*variant);
        if (!judged) return judged.error();
        bundle.witnesses = std::move(judged->steps);
    }
    for (const StageFile& file : stage_files(*variant->target)) {
        Result<std::string> bytes = bytes_of(file, *variant, *accepted);
        if (!bytes) return bytes.error();
        // SPIRV-Cross calls every entry point of Metal so, because `main` is taken there.
        const bool metal = variant->target->name == "msl";
        bundle.files.push_back({order.name() + std::string(file.extension), file.stage, file.kind,
                                metal ? "main0" : artifact_of(*variant, file.stage).entry,
                                std::move(*bytes)});
    }
    Result<Interface> interface = interface_of(*variant, *accepted);
    if (!interface) return interface.error();
    bundle.interface = std::move(*interface);
    bundle.slots = slots_of(accepted->shaders);
    add_notes(*variant, bundle);
    for (const auto& [sampler, settings] : reading_of(*variant).baked)
        bundle.baked.emplace_back(sampler, settings);
    return bundle;
}

Result<std::string> bundle_key(const dsl::Catalogue& catalogue, const plan::Order& order,
                               const BundleOptions& options) {
    const Result<Recorded> recorded = record_variant(catalogue, order.request);
    if (!recorded) return recorded.error();
    KeyText key;
    key.add("bundle 1");
    key.add(tool_id());
    key.add(options.judge ? "judge" : "accept");
    // The rest of the order, without what planning found out: it shapes nothing that is made here.
    plan::Order bare;
    bare.surface = order.surface;
    bare.request = order.request;
    key.add(plan::to_text(bare));
    const ir::Program& program = recorded->program;
    for (const std::string& text : {program.name, program.description}) key.add(text);
    for (const std::string& setting : program.settings) key.add(setting);
    for (const ir::Module* module : {&program.vertex, &program.pixel}) key.add(ir::print(*module));
    return key.hex();
}

}  // namespace intaglio::build
