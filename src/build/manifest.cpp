// Members in the order in which people read them.
#include "src/build/manifest.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace intaglio::build {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view scalars[] = {"float", "int", "bool"};
constexpr std::string_view kinds[] = {"buffer", "registers", "names"};

std::string_view word(ir::Stage stage) { return stage == ir::Stage::Vertex ? "vertex" : "pixel"; }

Json json_of(const Uniform& uniform) {
    Json json = {{"name", uniform.name},
                 {"scalar", scalars[static_cast<std::size_t>(uniform.scalar)]},
                 {"components", uniform.components},
                 {"elements", uniform.elements},
                 {"offset", uniform.offset},
                 {"stride", uniform.stride}};
    if (uniform.reg >= 0) json["register"] = uniform.reg;
    if (!uniform.comment.empty()) json["about"] = uniform.comment;
    return json;
}

Json json_of(const Sampler& sampler, const std::vector<MapRecord>& maps) {
    Json json = {{"name", sampler.name}};
    if (sampler.set >= 0) json["set"] = sampler.set;
    if (sampler.slot >= 0) json["slot"] = sampler.slot;
    if (sampler.sampler_slot >= 0) json["sampler_slot"] = sampler.sampler_slot;
    json["dimension"] = sampler.dimension;
    json["filter"] = sampler.nearest ? "nearest" : "linear";
    json["mipmaps"] = !sampler.one_level;
    for (const MapRecord& map : maps)
        if (std::find(map.samplers.begin(), map.samplers.end(), sampler.name) != map.samplers.end())
            json["map"] = map.kind;
    if (!sampler.comment.empty()) json["about"] = sampler.comment;
    return json;
}

Json json_of(const StageInterface& stage, const std::vector<MapRecord>& maps) {
    const UniformBlock& block = stage.block;
    Json uniforms = Json::array(), samplers = Json::array();
    for (const Uniform& uniform : block.uniforms) uniforms.push_back(json_of(uniform));
    for (const Sampler& sampler : stage.samplers) samplers.push_back(json_of(sampler, maps));
    Json json;
    if (!block.uniforms.empty()) {
        json["block"] = {{"kind", kinds[static_cast<std::size_t>(block.kind)]},
                         {"bytes", block.size}};
        if (block.kind == UniformBlock::Kind::Buffer) {
            if (block.set >= 0) json["block"]["set"] = block.set;
            json["block"]["binding"] = block.binding;
        }
        if (block.kind == UniformBlock::Kind::Registers) {
            json["block"]["first_register"] = block.first_register;
            json["block"]["registers"] = block.registers;
        }
        json["block"]["uniforms"] = std::move(uniforms);
    }
    json["samplers"] = std::move(samplers);
    return json;
}

Json json_of(const std::vector<plan::Figure>& figures) {
    Json json = Json::array();
    for (const plan::Figure& figure : figures)
        json.push_back({{"metric", figure.metric},
                        {"value", std::isfinite(figure.value) ? Json(figure.value) : Json()},
                        {"maker", figure.maker}});
    return json;
}

// Planning's figures, and what the bytecode says where planning did not.
std::vector<plan::Figure> costs_of(const BuiltVariant& variant) {
    std::vector<plan::Figure> costs = variant.order.costs;
    for (const plan::Figure& slots : variant.bundle.slots) {
        const auto same = [&](const plan::Figure& each) { return each.metric == slots.metric; };
        if (std::none_of(costs.begin(), costs.end(), same)) costs.push_back(slots);
    }
    return costs;
}

Json json_of(const BundleFile& file) {
    return {{"file", file.name},   {"stage", word(file.stage)},  {"kind", name_of(file.kind)},
            {"entry", file.entry}, {"bytes", file.bytes.size()}, {"hash", hash_of(file.bytes)}};
}

Json json_of(const BuiltVariant& variant, const std::vector<MapRecord>& maps) {
    const Bundle& bundle = variant.bundle;
    Json files = Json::array(), inputs = Json::array();
    for (const BundleFile& file : bundle.files) files.push_back(json_of(file));
    for (const VertexInput& input : bundle.interface.inputs) {
        Json each = {{"name", input.name}, {"components", input.components}};
        if (input.location >= 0) each["location"] = input.location;
        inputs.push_back(std::move(each));
    }
    const std::string order = order_file(variant.order.name());
    return {{"name", variant.order.name()},
            {"target", variant.order.request.target},
            {"order", order},
            {"command", fmt::format("intaglio build --order {} -o DIR", order)},
            {"request", Json::parse(plan::to_text(variant.order))["request"]},
            {"files", std::move(files)},
            {"inputs", std::move(inputs)},
            {"vertex", json_of(bundle.interface.vertex, maps)},
            {"pixel", json_of(bundle.interface.pixel, maps)},
            {"costs", json_of(costs_of(variant))},
            {"errors", json_of(variant.order.errors)},
            {"witnesses", bundle.witnesses},
            {"notes", bundle.notes}};
}

Json json_of(const MapRecord& map) {
    Json json = {{"kind", map.kind}};
    if (!map.settings.empty()) json["settings"] = map.settings;
    json["samplers"] = map.samplers;
    if (!map.file.empty()) json["file"] = map.file;
    if (!map.source.empty()) json["source"] = map.source;
    if (!map.hash.empty()) json["hash"] = map.hash;
    return json;
}

}  // namespace

std::string manifest_text(const std::string& scene, const std::vector<BuiltSurface>& surfaces) {
    Json all = Json::array();
    for (const BuiltSurface& surface : surfaces) {
        Json variants = Json::array(), maps = Json::array();
        for (const BuiltVariant& variant : surface.variants)
            variants.push_back(json_of(variant, surface.maps));
        for (const MapRecord& map : surface.maps) maps.push_back(json_of(map));
        all.push_back(
            {{"name", surface.name},
             {"header", {{"file", header_file(surface.name)}, {"hash", surface.header_hash}}},
             {"maps", std::move(maps)},
             {"variants", std::move(variants)}});
    }
    const Json json = {{"schema", manifest_schema}, {"scene", scene}, {"surfaces", std::move(all)}};
    return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<std::vector<std::string>> files_listed(const std::string& manifest,
                                              const std::string& file) {
    try {
        const Json json = Json::parse(manifest);
        std::vector<std::string> names;
        for (const Json& surface : json.at("surfaces")) {
            names.push_back(surface.at("header").at("file"));
            for (const Json& map : surface.at("maps"))
                if (map.contains("file")) names.push_back(map.at("file"));
            for (const Json& variant : surface.at("variants")) {
                names.push_back(variant.at("order"));
                for (const Json& each : variant.at("files")) names.push_back(each.at("file"));
            }
        }
        return names;
    } catch (const Json::exception&) {
        return input_error("manifest-syntax", "this is no manifest of `intaglio build`", file);
    }
}

std::string to_text(const std::vector<MapRecord>& maps) {
    Json all = Json::array();
    for (const MapRecord& map : maps) all.push_back(json_of(map));
    return all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<std::vector<MapRecord>> read_maps(const std::string& text, const std::string& file) {
    try {
        std::vector<MapRecord> maps;
        for (const Json& each : Json::parse(text)) {
            MapRecord map;
            map.kind = each.at("kind");
            map.settings = each.value("settings", "");
            map.samplers = each.at("samplers").get<std::vector<std::string>>();
            map.file = each.value("file", "");
            map.source = each.value("source", "");
            map.hash = each.value("hash", "");
            maps.push_back(std::move(map));
        }
        return maps;
    } catch (const Json::exception&) {
        return input_error("maps-syntax", "this is no list of a surface's maps", file);
    }
}

}  // namespace intaglio::build
