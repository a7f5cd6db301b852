// Recording a surface, whole or pass by pass: a surface that is not split is one pass that does
// all.
#include "generator/dsl/passes.h"

#include <charconv>
#include <optional>

#include <fmt/format.h>

#include "generator/base/nearest.h"
#include "generator/dsl/surface_parts.h"

namespace intaglio::dsl {
namespace {

// What one pass does.
struct Work {
    int number = 0;    // 0 reads no earlier pass
    int section = -1;  // of the search; -1: no search
    bool shadow = false;
    bool output = false;  // the shading, if the output wants it; else the pass hands on
};

std::vector<Work> works_of(const Split& split) {
    std::vector<Work> works;
    const auto begin = [&] { works.push_back({static_cast<int>(works.size()), -1, false, false}); };
    for (int section = 0; section < split.sections; ++section) {
        begin();
        works.back().section = section;
    }
    if (split.shadow) begin();
    works.back().shadow = true;
    if (split.shading) begin();
    works.back().output = true;
    return works;
}

float2 code(std::string_view name, std::string_view comment) { return uniform<2>(name, comment); }

// The earlier pass' picture at this pixel; w is the last component, whose meaning depends on the
// pass.
struct TakenOver {
    float2 uv;
    float1 height, last;
};

TakenOver take_over(float2 uv) {
    Step step("take over", "What the pass before found at this pixel.");
    const sampler2D map("displaced_map", "picture of the pass before, of the same size",
                        sampler2D::Filter::Nearest);
    // The vertex stage hands down clip space scaled to the picture; its w is divided out here,
    // because a quotient does not interpolate in perspective.
    const float3 place = input<3>("place");
    const float4 texel = let("taken", map.sample_level(place.xy() / place.z(), 0.0f));
    const float2 decode = code("colour_to_offset", "scale and bias that undo offset_to_colour");
    return {let("taken_uv", uv + (texel.xy() * decode.x() + decode.y())), texel.z(), texel.w()};
}

float4 hand_on(const Hit& hit, float2 uv, float1 last) {
    Step step("hand on", "The offset, coded for the picture's format, for the next pass.");
    const float2 encode =
        code("offset_to_colour", "scale and bias that bring offsets into the picture's format");
    float1 height = hit.height;
    if (hit.exit_height) height = select(*hit.found, hit.height, *hit.exit_height);
    return let("handed_on", float4((hit.uv - uv) * encode.x() + encode.y(), height, last));
}

Ray section_of(const Ray& whole, const Relief& section, const std::optional<TakenOver>& before) {
    const float share = 1.0f / static_cast<float>(section.sections);
    Ray ray{whole.at(static_cast<float>(section.section) * share), whole.view, whole.reach * share};
    ray.polygon_uv = whole.polygon_uv;
    if (before) ray.entry_height = section.in_section(before->height);
    return ray;
}

// The search in one section; what an earlier section found stays.
Hit find_in_section(const Surface& surface, const Relief& relief, const Ray& whole, int number,
                    int count, const std::optional<TakenOver>& before) {
    const float share = 1.0f / static_cast<float>(count);
    Relief section = relief;
    section.section = number;
    section.sections = count;
    section.scale = relief.scale * share;
    Hit hit = surface.search->find(section, section_of(whole, section, before));
    if (!hit.found) {
        Recorder::current().fail(input_error(
            "split-search", fmt::format("the search of {} does not say whether it met the relief, "
                                        "so it cannot run in sections; split=shading it can",
                                        surface.name)));
        hit.found = bool1(true);
    }
    hit.height = section.in_whole(hit.height);
    if (hit.exit_height) hit.exit_height = section.in_whole(*hit.exit_height);
    if (!before) return hit;
    const bool1 found_before = before->last >= 0.5f;
    hit.uv = select(found_before, before->uv, hit.uv);
    hit.height = select(found_before, before->height, hit.height);
    hit.found = found_before || *hit.found;
    return hit;
}

Hit search(const Surface& surface, const Relief& relief, const Ray& ray, const Work& work,
           const Split& split, const std::optional<TakenOver>& before) {
    Step step("search", "Where does the view ray meet the relief first?");
    if (split.sections == 1) return surface.search->find(relief, ray);
    return find_in_section(surface, relief, ray, work.section, split.sections, before);
}

// The lights that a pass looks at.  Where it does not shade, that is the first alone, whose
// visibility it writes.
std::vector<Light> lights_of(const Surface& surface, const Relief& relief, const Hit& hit,
                             const Work& work, const std::optional<TakenOver>& before) {
    const int shadowing = surface.lighting->shadowing();
    const bool shades = work.output && surface.output->shaded();
    if (!shades && !work.shadow && !work.output) return {};
    const int count = std::min(surface.lighting->lights.value(), shades ? most_lights : 1);
    std::vector<Light> lights;
    for (int number = 0; number < count; ++number) {
        const float3 direction =
            unit_input(name_of_light("to_light", number), name_of_light("light", number));
        const auto visibility = [&] {
            if (number >= shadowing) return float1(1.0f);
            if (number > 0 && !surface.shadow->depends_on_light()) return lights[0].visibility;
            if (!work.shadow) return before->last;
            Step step("shadow", "How much of the light reaches the point we see?");
            return surface.shadow->visibility(relief, hit, direction);
        };
        lights.push_back(
            {number, direction, let(name_of_light("visibility", number), visibility())});
    }
    return lights;
}

Status record_pixel(const Surface& surface, const RecordOptions& options, const Split& split,
                    const Work& work, ir::Program& program) {
    Recorder recorder(program.pixel);
    program.per_vertex = apply_schedules(surface, options, recorder);
    if (pass_count(split) > 1) recorder.allow_absent_loops();

    const float2 uv = input<2>("uv");
    std::optional<TakenOver> before;
    const PolygonPoint from = polygon_point(surface, uv);
    if (work.number > 0) before = take_over(from.local);
    const float3 view = unit_input("to_eye", "view");
    const Relief relief = make_relief(surface);
    const Hit hit =
        work.section < 0
            ? Hit{before->uv, before->height}
            : search(surface, relief, make_ray(surface, relief, from, view), work, split, before);
    const std::vector<Light> lights = lights_of(surface, relief, hit, work, before);
    const float1 visibility = lights.empty() ? float1(1.0f) : lights[0].visibility;
    if (!work.output) {
        const bool last_section = work.section == split.sections - 1;
        const float1 last = work.shadow    ? visibility
                            : last_section ? float1(1.0f)
                                           : select(*hit.found, float1(1.0f), 0.0f);
        program.pixel.outputs = {{"handed_on", ir::float4, ir::Semantic::Target}};
        return recorder.finish({hand_on(hit, from.local, last).id()});
    }
    const Hit met = from.continuous(hit);
    const bool reads_locally = surface.relief->local_origin == 2;
    const float3 colour = surface.output->shaded()
                              ? shade(surface, relief, reads_locally ? hit : met, uv, view, lights)
                              : float3(0.0f);
    const float4 value =
        let(surface.output->name(), surface.output->write(met, visibility, colour));
    program.pixel.outputs = {{surface.output->name(), ir::float4, ir::Semantic::Target}};
    std::vector<ir::ValueId> values = {value.id()};
    if (const std::optional<float1> depth = surface.output->depth(relief, hit)) {
        program.pixel.outputs.push_back({"depth", ir::float1, ir::Semantic::Depth});
        values.push_back(depth->id());
    }
    if (surface.relief->clip_tile == 1) {
        program.pixel.outputs.push_back({"inside", ir::float1, ir::Semantic::Clip});
        values.push_back(inside_tile(met).id());
    }
    return recorder.finish(values);
}

Status record_vertex(const Surface& surface, const Work& work, ir::Program& program) {
    Recorder recorder(program.vertex);
    const Vertex vertex = surface.vertex->transform(surface.lighting->lights);
    program.vertex.outputs = {{"position", ir::float4, ir::Semantic::Position},
                              {"uv", ir::float2, ir::Semantic::Interpolant},
                              {"to_eye", ir::float3, ir::Semantic::Interpolant}};
    std::vector<ir::ValueId> values = {vertex.position.id(), vertex.uv.id(), vertex.to_eye.id()};
    for (std::size_t i = 0; i < vertex.to_lights.size(); ++i) {
        program.vertex.outputs.push_back({name_of_light("to_light", static_cast<int>(i)),
                                          ir::float3, ir::Semantic::Interpolant});
        values.push_back(vertex.to_lights[i].id());
    }
    if (surface.relief->ray_per_vertex == 1) {
        program.vertex.outputs.push_back({"reach", ir::float2, ir::Semantic::Interpolant});
        const float3 view = let("view", normalize(vertex.to_eye));
        values.push_back(Ray::reach_of(relief_scale(), view).id());
    }
    if (work.output && surface.output->writes_depth()) {
        if (!vertex.depth_line)
            return input_error("vertex-depth",
                               fmt::format("{} writes depth, and its vertex work hands on no "
                                           "depth_line to compute it from",
                                           surface.name));
        program.vertex.outputs.push_back({"depth_line", ir::float4, ir::Semantic::Interpolant});
        values.push_back(vertex.depth_line->id());
    }
    if (work.number > 0) {
        program.vertex.outputs.push_back({"place", ir::float3, ir::Semantic::Interpolant});
        const float4 to_picture = uniform<4>(
            "pixel_place", "scale (xy) and bias (zw) from clip space to the picture's coordinates");
        const float1 w = vertex.position.w();
        const float2 scaled = vertex.position.xy() * to_picture.xy() + to_picture.zw() * w;
        values.push_back(let("place", float3(scaled, w)).id());
    }
    return recorder.finish(values);
}

// The knobs of the techniques that a pass carries out.
std::vector<std::string> settings_of(const Surface& surface, const Work& work) {
    std::vector<const Technique*> used = {surface.vertex.get(), surface.relief.get(),
                                          surface.lighting.get()};
    if (work.section >= 0) used.push_back(surface.search.get());
    if (work.shadow) used.push_back(surface.shadow.get());
    if (work.output && surface.output->shaded()) {
        used.push_back(surface.normal.get());
        used.push_back(surface.shading.get());
    }
    if (work.output) used.push_back(surface.output.get());
    std::vector<std::string> all;
    for (const Technique* technique : used) add_settings(surface, *technique, all);
    return all;
}

Result<ir::Program> record(const Surface& surface, const RecordOptions& options, const Split& split,
                           const Work& work, std::string name, std::string description) {
    if (Status status = check_techniques(surface); !status) return status.error();
    ir::Program program;
    program.name = std::move(name);
    program.description = std::move(description);
    program.settings = settings_of(surface, work);
    program.vertex.name = program.pixel.name = program.name;
    program.vertex.stage = ir::Stage::Vertex;
    program.pixel.stage = ir::Stage::Pixel;
    if (Status status = record_pixel(surface, options, split, work, program); !status)
        return status.error();
    if (Status status = record_vertex(surface, work, program); !status) return status.error();
    return program;
}

Diagnostic syntax_error(std::string_view item) {
    const std::vector<std::string> cuts = {"shading", "shadow", "sections=2"};
    return input_error("split-syntax",
                       fmt::format("{}; sections are 1 to {}",
                                   unknown_name_sentence("cut", item, cuts), Split::most_sections));
}

}  // namespace

Result<Split> parse_split(std::string_view text) {
    Split split;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t comma = std::min(text.find(',', begin), text.size());
        const std::string_view item = text.substr(begin, comma - begin);
        constexpr std::string_view sections = "sections=";
        if (item == "shading") {
            split.shading = true;
        } else if (item == "shadow") {
            split.shadow = true;
        } else if (item.starts_with(sections)) {
            const std::string_view number = item.substr(sections.size());
            const auto [end, error] =
                std::from_chars(number.data(), number.data() + number.size(), split.sections);
            if (error != std::errc() || end != number.data() + number.size() ||
                split.sections < 1 || split.sections > Split::most_sections)
                return syntax_error(item);
        } else {
            return syntax_error(item);
        }
        begin = comma + 1;
    }
    return split;
}

std::string to_string(const Split& split) {
    std::vector<std::string> items;
    if (split.sections > 1) items.push_back(fmt::format("sections={}", split.sections));
    if (split.shadow) items.emplace_back("shadow");
    if (split.shading) items.emplace_back("shading");
    return fmt::format("{}", fmt::join(items, ","));
}

int pass_count(const Split& split) {
    return split.sections + (split.shadow ? 1 : 0) + (split.shading ? 1 : 0);
}

std::string pass_work(const Split& split, int pass) {
    const Work work = works_of(split)[static_cast<std::size_t>(pass - 1)];
    std::vector<std::string> parts;
    if (work.section >= 0)
        parts.push_back(split.sections == 1 ? "search"
                                            : fmt::format("section {} of {} of the search",
                                                          work.section + 1, split.sections));
    if (work.shadow) parts.emplace_back("shadow");
    if (work.output) parts.emplace_back("shading and output");
    return fmt::format("{}", fmt::join(parts, ", "));
}

Result<ir::Program> record_surface(const Surface& surface, const RecordOptions& options) {
    return record(surface, options, {}, works_of({}).front(), surface.name, surface.description);
}

Result<ir::Program> record_pass(const Surface& surface, const RecordOptions& options,
                                const Split& split, int pass) {
    const int count = pass_count(split);
    if (pass < 1 || pass > count)
        return input_error("split-pass",
                           fmt::format("there is no pass {}: this split has {}", pass,
                                       count == 1 ? "one" : fmt::format("1 to {}", count)));
    if (count == 1) return record_surface(surface, options);
    const int shadowing = surface.lighting->shadowing();
    if (split.shading && shadowing > 1 && surface.shadow->depends_on_light())
        return input_error(
            "split-lights",
            fmt::format("the picture between the passes holds the shadow of one light, and {} has "
                        "shadows of {}: split=shadow finds them beside the shading, and "
                        "shadowed_lights=1 asks for one",
                        surface.name, shadowing));
    // A loop that no pass has is an error, and one that another pass has is not.
    if (const auto whole = record_surface(surface, options); !whole) return whole.error();
    std::string description = surface.description;
    if (!description.empty()) description += "\n";
    description += fmt::format("pass {} of {}: {}", pass, count, pass_work(split, pass));
    return record(surface, options, split, works_of(split)[static_cast<std::size_t>(pass - 1)],
                  fmt::format("{}, pass {} of {}", surface.name, pass, count), description);
}

Result<std::vector<ir::Program>> record_passes(const Surface& surface, const RecordOptions& options,
                                               const Split& split) {
    std::vector<ir::Program> programs;
    for (int pass = 1; pass <= pass_count(split); ++pass) {
        Result<ir::Program> program = record_pass(surface, options, split, pass);
        if (!program) return program.error();
        programs.push_back(std::move(*program));
    }
    return programs;
}

}  // namespace intaglio::dsl
