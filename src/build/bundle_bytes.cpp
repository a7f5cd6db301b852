// A bundle as CBOR: bytes stay bytes, and its reader is the JSON library's.
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "src/build/bundle.h"
#include "src/build/source_id.h"
#include "src/check/versions.h"

namespace intaglio::build {
namespace {

using nlohmann::json;

constexpr int bundle_format = 1;

json json_of(const Uniform& uniform) {
    return {uniform.name,       uniform.comment,  static_cast<int>(uniform.scalar),
            uniform.components, uniform.elements, uniform.offset,
            uniform.stride,     uniform.reg};
}

// The elements of an array, in order.
template <typename... Fields>
void read_row(const json& from, Fields&... fields) {
    std::size_t i = 0;
    (from.at(i++).get_to(fields), ...);
}

Uniform uniform_of(const json& from) {
    Uniform uniform;
    read_row(from, uniform.name, uniform.comment, uniform.scalar, uniform.components,
             uniform.elements, uniform.offset, uniform.stride, uniform.reg);
    return uniform;
}

json json_of(const Sampler& sampler) {
    return {sampler.name,         sampler.comment,   sampler.set,     sampler.slot,
            sampler.sampler_slot, sampler.dimension, sampler.nearest, sampler.one_level};
}

Sampler sampler_of(const json& from) {
    Sampler sampler;
    read_row(from, sampler.name, sampler.comment, sampler.set, sampler.slot, sampler.sampler_slot,
             sampler.dimension, sampler.nearest, sampler.one_level);
    return sampler;
}

json json_of(const StageInterface& stage) {
    json uniforms = json::array(), samplers = json::array();
    for (const Uniform& uniform : stage.block.uniforms) uniforms.push_back(json_of(uniform));
    for (const Sampler& sampler : stage.samplers) samplers.push_back(json_of(sampler));
    const UniformBlock& block = stage.block;
    return {{"kind", static_cast<int>(block.kind)},
            {"set", block.set},
            {"binding", block.binding},
            {"first_register", block.first_register},
            {"registers", block.registers},
            {"size", block.size},
            {"uniforms", uniforms},
            {"samplers", samplers}};
}

StageInterface stage_of(const json& from) {
    StageInterface stage;
    stage.block.kind = static_cast<UniformBlock::Kind>(from.at("kind").get<int>());
    stage.block.set = from.at("set");
    stage.block.binding = from.at("binding");
    stage.block.first_register = from.at("first_register");
    stage.block.registers = from.at("registers");
    stage.block.size = from.at("size");
    for (const json& each : from.at("uniforms")) stage.block.uniforms.push_back(uniform_of(each));
    for (const json& each : from.at("samplers")) stage.samplers.push_back(sampler_of(each));
    return stage;
}

json bytes_json(const std::string& bytes) {
    return json::binary(std::vector<std::uint8_t>(bytes.begin(), bytes.end()));
}

Bundle read(const json& from) {
    Bundle bundle;
    for (const json& each : from.at("files")) {
        const auto& bytes = each.at(4).get_binary();
        bundle.files.push_back({each.at(0), static_cast<ir::Stage>(each.at(1).get<int>()),
                                static_cast<FileKind>(each.at(2).get<int>()), each.at(3),
                                std::string(bytes.begin(), bytes.end())});
    }
    bundle.interface.vertex = stage_of(from.at("vertex"));
    bundle.interface.pixel = stage_of(from.at("pixel"));
    for (const json& each : from.at("inputs"))
        bundle.interface.inputs.push_back({each.at(0), each.at(1), each.at(2)});
    bundle.witnesses = from.at("witnesses");
    bundle.notes = from.at("notes");
    for (const json& each : from.at("slots"))
        bundle.slots.push_back({each.at(0), each.at(1), each.at(2)});
    for (const json& each : from.at("baked"))
        bundle.baked.emplace_back(each.at(0).get<std::string>(), each.at(1).get<std::string>());
    return bundle;
}

}  // namespace

std::string to_bytes(const Bundle& bundle) {
    json files = json::array(), inputs = json::array(), slots = json::array(),
         baked = json::array();
    for (const BundleFile& file : bundle.files)
        files.push_back({file.name, static_cast<int>(file.stage), static_cast<int>(file.kind),
                         file.entry, bytes_json(file.bytes)});
    for (const VertexInput& input : bundle.interface.inputs)
        inputs.push_back({input.name, input.components, input.location});
    for (const plan::Figure& figure : bundle.slots)
        slots.push_back({figure.metric, figure.value, figure.maker});
    for (const auto& [sampler, settings] : bundle.baked) baked.push_back({sampler, settings});
    const json all = {{"format", bundle_format},
                      {"files", files},
                      {"vertex", json_of(bundle.interface.vertex)},
                      {"pixel", json_of(bundle.interface.pixel)},
                      {"inputs", inputs},
                      {"witnesses", bundle.witnesses},
                      {"notes", bundle.notes},
                      {"slots", slots},
                      {"baked", baked}};
    const std::vector<std::uint8_t> bytes = json::to_cbor(all);
    return {bytes.begin(), bytes.end()};
}

Result<Bundle> bundle_of(const std::string& bytes) {
    // The library's readers of members throw; nothing of it leaves this function.
    try {
        const json all = json::from_cbor(bytes);
        if (all.at("format") != bundle_format)
            return input_error("bundle-broken", "these bytes are of another version of the tool");
        return read(all);
    } catch (const json::exception& error) {
        return input_error("bundle-broken",
                           fmt::format("these bytes are no variant of a build: {}", error.what()));
    }
}

std::string tool_id() { return fmt::format("{} {}", source_id(), check::witness_versions()); }

}  // namespace intaglio::build
