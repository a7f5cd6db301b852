// What is emitted declares nothing that nobody reads: no uniform, sampler or interpolant, in texts
// and in Direct3D 9's declarations and constant table; with what is known folded in as well.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <regex>
#include <set>

#include "src/variant/variant.h"
#include "templates/all_techniques.h"

namespace intaglio {
namespace {

const passes::Known known = {{{"scale", {0.05f}}, {"gloss", {0}}, {"map_size", {64, 64}}},
                             {{"view.z", {0.25f, 1}}, {"light.z", {-1, -0.1f}}}};

Result<Variant> make(const std::string& surface, const std::string& target, bool folded) {
    static const dsl::Catalogue catalogue = templates::all_techniques();
    VariantRequest request;
    request.surface = surface;
    request.target = target;
    if (folded) {
        const Result<Recorded> recorded = record_variant(catalogue, request);
        if (!recorded) return recorded.error();
        request.known = passes::part_of(known, recorded->program);
    }
    return make_variant(catalogue, request);
}

std::vector<std::string> surfaces() {
    std::vector<std::string> all;
    const dsl::Catalogue catalogue = templates::all_techniques();
    for (const auto& row : catalogue.searches)
        all.push_back("search=" + row.name + ",shading=lambert");
    for (const auto& row : catalogue.shadows) all.push_back("search=none,shadow=" + row.name);
    for (const auto& row : catalogue.normals) all.push_back("search=parallax,normal=" + row.name);
    for (const auto& row : catalogue.shadings) all.push_back("search=none,shading=" + row.name);
    for (const auto& row : catalogue.outputs) all.push_back("search=parallax,output=" + row.name);
    return all;
}

// How often each word stands in the text, comments left out.
std::map<std::string, int> words_of(const std::string& text) {
    const std::string code = std::regex_replace(text, std::regex("//[^\n]*"), "");
    std::map<std::string, int> words;
    const std::regex word("[A-Za-z_][A-Za-z0-9_]*");
    for (auto at = std::sregex_iterator(code.begin(), code.end(), word);
         at != std::sregex_iterator(); ++at)
        ++words[at->str()];
    return words;
}

TEST(Unused, NoTextDeclaresWhatNobodyReads) {
    int looked_at = 0;
    for (const char* target : {"glsl_450", "glsl_120", "hlsl_5_0", "hlsl_3_0"})
        for (const std::string& surface : surfaces())
            for (bool folded : {false, true}) {
                SCOPED_TRACE(surface + " on " + target + (folded ? ", folded" : ""));
                const Result<Variant> variant = make(surface, target, folded);
                if (!variant && is_refusal(variant.error())) continue;
                ASSERT_TRUE(variant.ok()) << to_string(variant.error());
                const auto pixel = words_of(variant->pixel.text);
                const auto vertex = words_of(variant->vertex.text);
                const ir::Program& program = variant->program;
                const auto expect_read = [&](const auto& words, const std::string& name) {
                    const auto found = words.find(name);
                    looked_at += found == words.end() ? 0 : 1;
                    EXPECT_FALSE(found != words.end() && found->second == 1)
                        << name << " is declared, and nobody reads it";
                };
                for (const auto& uniform : program.pixel.uniforms) expect_read(pixel, uniform.name);
                for (const auto& sampler : program.pixel.samplers) expect_read(pixel, sampler.name);
                for (const auto& input : program.pixel.inputs) expect_read(pixel, input.name);
                for (const auto& uniform : program.vertex.uniforms)
                    expect_read(vertex, uniform.name);
                for (const auto& input : program.vertex.inputs) expect_read(vertex, input.name);
                // The stages have the same interpolants; of uv the vertex stage has an attribute
                // too.
                for (const auto& output : program.vertex.outputs)
                    if (output.semantic == ir::Semantic::Interpolant && output.name != "uv") {
                        EXPECT_EQ(vertex.contains(output.name), pixel.contains(output.name))
                            << output.name;
                    }
            }
    EXPECT_GT(looked_at, 1000);
}

using Register = std::pair<d3d9::File, int>;

std::set<Register> registers_read(const d3d9::Shader& shader) {
    std::set<Register> read;
    for (const d3d9::Instruction& instruction : shader.instructions)
        for (const d3d9::Source& source : instruction.sources)
            read.insert({source.file, source.index});
    return read;
}

void expect_all_read(const d3d9::Shader& shader) {
    const std::set<Register> read = registers_read(shader);
    for (const d3d9::Declaration& declaration : shader.declarations) {
        const d3d9::Destination& target = declaration.target;
        if (target.file == d3d9::File::Output) continue;
        EXPECT_TRUE(read.contains({target.file, target.index}))
            << d3d9::info(target.file).name << target.index << " is declared";
    }
    for (const d3d9::Definition& definition : shader.definitions)
        EXPECT_TRUE(read.contains({definition.file, definition.index}))
            << "def c" << definition.index;
    for (const d3d9::Constant& constant : shader.constants) {
        const d3d9::File file =
            constant.set == d3d9::Constant::Set::Sampler ? d3d9::File::Sampler : d3d9::File::Const;
        for (int i = 0; i < constant.count; ++i)
            EXPECT_TRUE(read.contains({file, constant.index + i})) << constant.name << " row " << i;
    }
}

TEST(Unused, NoBytecodeDeclaresWhatNobodyReads) {
    int looked_at = 0;
    const std::vector<std::pair<std::string, std::string>> all = {
        {"parallax", "ps_2_0"},
        {"search=none,shading=ambient_only", "ps_2_0"},
        {"search=parallax,output=displaced", "ps_2_b"},
        {"search=none,normal=blinn", "ps_2_b"},
        {"parallax_occlusion", "ps_3_0"},
        {"search=none,shadow=march", "ps_3_0"},
        {"search=none,shadow=horizon", "ps_3_0"}};
    for (const auto& [surface, target] : all)
        for (bool folded : {false, true}) {
            SCOPED_TRACE(surface + " on " + target + (folded ? ", folded" : ""));
            const Result<Variant> variant = make(surface, target, folded);
            if (!variant && is_refusal(variant.error())) continue;
            ASSERT_TRUE(variant.ok()) << to_string(variant.error());
            for (ir::Stage stage : {ir::Stage::Pixel, ir::Stage::Vertex}) {
                const Result<d3d9::Shader> shader = decode_stage(*variant, stage);
                ASSERT_TRUE(shader.ok()) << to_string(shader.error());
                expect_all_read(*shader);
                ++looked_at;
                for (const d3d9::Constant& constant : shader->constants)
                    EXPECT_FALSE(folded && known.uniforms.contains(constant.name))
                        << constant.name << " is a constant, and in the constant table";
            }
        }
    EXPECT_EQ(looked_at, 28);
}

}  // namespace
}  // namespace intaglio
