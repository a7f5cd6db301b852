// The emitted shaders of a page, what their lines take, and whose lines of C++ those are.
#include <algorithm>

#include "generator/target/d3d9/assembly.h"
#include "generator/target/d3d9/explain.h"
#include "src/measure/cost.h"
#include "src/report/page_data.h"
#include "src/variant/explain.h"

namespace intaglio::report {
namespace {

using Json = nlohmann::ordered_json;

// Slots of each line of an assembly text; null where a line is no instruction.
Json slots_by_line(const std::string& text, const d3d9::Shader& shader) {
    Json lines = Json::array();
    std::size_t next = 0;
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        const std::size_t first = std::min(text.find_first_not_of(' ', begin), end);
        const std::string_view line(text.data() + first, end - first);
        if (next < shader.instructions.size() &&
            line.substr(0, line.find(';')).starts_with(d3d9::text_of(shader.instructions[next]))) {
            const d3d9::Slots slots = d3d9::slots_of(shader.instructions[next++]);
            lines.push_back({slots.arithmetic, slots.texture});
        } else {
            lines.push_back(nullptr);
        }
        begin = end + 1;
    }
    return lines;
}

std::string place_of(const std::string& file, int line) {
    return file.empty() ? std::string() : file + ":" + std::to_string(line);
}

// Who spends what the pixel stage of a variant that fits costs.
Json spending(const ExplainedStage& stage) {
    const bool counts_slots = stage.profile.has_value();
    Json json = {{"unit", counts_slots ? "slots" : "operations"},
                 {"lines", Json::array()},
                 {"reads", Json::array()}};
    for (const d3d9::Spent& line : stage.explanation.lines)
        json["lines"].push_back({{"step", line.step},
                                 {"place", place_of(line.file, line.line)},
                                 {"arithmetic", line.slots.arithmetic},
                                 {"texture", line.slots.texture}});
    for (const d3d9::TextureRead& read : stage.explanation.reads)
        json["reads"].push_back({{"sampler", read.sampler},
                                 {"level", counts_slots ? Json(read.level) : Json()},
                                 {"step", read.step},
                                 {"place", place_of(read.file, read.line)}});
    return json;
}

}  // namespace

Status add_sources(PageData& page, const dsl::Catalogue& catalogue) {
    Json& sources = page.json["sources"] = Json::array();
    for (std::size_t i = 0; i < page.variants.size(); ++i) {
        const Result<Variant> variant = make_variant(catalogue, page.variants[i]);
        if (!variant && is_refusal(variant.error())) continue;  // the data says so as well
        if (!variant) return variant.error();
        const Result<Product> product = product_of(*variant, ir::Stage::Pixel);
        if (!product) return product.error();
        if (product->binary) continue;
        const Result<ExplainedVariant> explained = explain_variant(catalogue, page.variants[i]);
        if (!explained) return explained.error();
        Json source = {{"text", product->bytes}};
        for (const ExplainedStage& stage : explained->stages)
            if (stage.stage == ir::Stage::Pixel) source["spent"] = spending(stage);
        Json& row = page.json["variants"][i];
        if (profile_of(*variant->target)) {
            const Result<d3d9::Shader> shader = decode_stage(*variant, ir::Stage::Pixel);
            if (!shader) return shader.error();
            source["lines"] = slots_by_line(product->bytes, *shader);
            source["line_units"] = {"Arithmetic slots", "Texture slots"};
            source["lines_note"] = "Slots of each line by Direct3D's charge.";
            row["resources"] = Json::array();
            for (const d3d9::Headroom& headroom : d3d9::headroom(*shader))
                row["resources"].push_back({{"resource", headroom.resource},
                                            {"used", headroom.used},
                                            {"limit", headroom.limit}});
        }
        row["source"] = sources.size();
        sources.push_back(std::move(source));
    }
    return Done{};
}

Status add_chips(PageData& page, const dsl::Catalogue& catalogue,
                 const std::vector<std::string>& chips) {
    const Result<measure::ChipCompilers> compilers = measure::ChipCompilers::create(chips);
    if (!compilers) {
        for (const std::string& chip : chips)
            page.json["made_by"][chip] = "not known here: " + compilers.error().message;
        return Done{};
    }
    for (std::size_t i = 0; i < page.variants.size(); ++i) {
        const Result<Variant> variant = make_variant(catalogue, page.variants[i]);
        if (!variant && is_refusal(variant.error())) continue;
        if (!variant) return variant.error();
        if (profile_of(*variant->target)) continue;  // what MojoShader translates is not what it is
        const Result<check::Program> program = link_variant(*variant);
        if (!program) continue;  // a language that no device runs as it is
        const Result<std::vector<measure::Chip>> made = compilers->compile(*program);
        if (!made) return made.error();
        for (const measure::Chip& chip : *made) {
            if (!chip.pixel) continue;
            const auto known = [](const std::optional<double>& value) {
                return value ? Json(*value) : Json();
            };
            page.json["variants"][i]["chips"][chip.chip] = {
                {"instructions", known(chip.pixel->instructions)},
                {"vector_registers", known(chip.pixel->vector_registers)},
                {"latency", known(chip.pixel->latency)},
                {"inverse_throughput", known(chip.pixel->inverse_throughput)}};
            page.json["made_by"][chip.chip] =
                "instructions, registers and cycles of the pixel stage by the compiler of " +
                chip.driver + ", for the chip " + chip.chip + ", which is not there";
        }
    }
    return Done{};
}

}  // namespace intaglio::report
