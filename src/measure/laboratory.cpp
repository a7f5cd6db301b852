// A case from its variant to its numbers.
#include "src/measure/laboratory.h"

#include <fmt/format.h>

#include "generator/ir/print.h"
#include "src/measure/command.h"
#include "src/measure/evaluated.h"

namespace intaglio::measure {
namespace {

d3d9::Arithmetic unit_of(Arithmetic arithmetic) {
    switch (arithmetic) {
        case Arithmetic::Fp32: return d3d9::Arithmetic::Fp32;
        case Arithmetic::Fp24: return d3d9::Arithmetic::Fp24;
        case Arithmetic::Fp16: break;
    }
    return d3d9::Arithmetic::Fp16Partial;
}

ir::Precision precision_of(Arithmetic arithmetic) {
    switch (arithmetic) {
        case Arithmetic::Fp32: return ir::Precision::Single;
        case Arithmetic::Fp24: return ir::Precision::Narrow24;
        case Arithmetic::Fp16: break;
    }
    return ir::Precision::Narrow16;
}

// A shader of bytecode, all in 16 bits where that is asked for.
Result<InterpretedQuad> interpreted(const Variant& variant, const Textures& textures,
                                    const Case& what, int size) {
    Result<InterpretedQuad> quad =
        InterpretedQuad::prepare(variant, textures, what.scale, size, size);
    if (!quad || what.arithmetic != Arithmetic::Fp16) return quad;
    return quad->with_partial_precision();
}

// Hits as the picture between two passes holds them: the offset from the pixel's own place.
vulkan::Texture offsets_of(vulkan::Picture picture) {
    vulkan::Texture texture;
    texture.width = picture.width;
    texture.height = picture.height;
    texture.levels.resize(1);
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const std::array<float, 4>& hit = picture.at(x, y);
            texture.levels[0].insert(
                texture.levels[0].end(),
                {static_cast<float>(static_cast<double>(hit[0]) - (x + 0.5) / picture.width),
                 static_cast<float>(static_cast<double>(hit[1]) - (y + 0.5) / picture.height),
                 hit[2], hit[3]});
        }
    texture.filter = texture.mip_filter = vulkan::Texture::Filter::Nearest;
    texture.wrap = vulkan::Texture::Wrap::Clamp;
    texture.format = vulkan::Texture::Format::Rgba32Float;
    return texture;
}

vulkan::Picture exact_hits(const ExactPicture& exact) {
    vulkan::Picture picture{exact.width, exact.height, {}};
    for (std::size_t i = 0; i < exact.hits.size(); ++i) {
        const reference::Hit& hit = exact.hits[i];
        picture.pixels.push_back({static_cast<float>(hit.uv.x), static_cast<float>(hit.uv.y),
                                  static_cast<float>(hit.height), exact.lit[i] ? 1.0f : 0.0f});
    }
    return picture;
}

// From which pass on a surface is drawn at hits that are given.
enum class From { Shadow, Shading };

// Whether the surface asks for the shadows of several lights: the picture between passes, which
// takes the shadow where it is exact or in another arithmetic, holds one.
bool has_several_shadows(const dsl::Catalogue& catalogue, const VariantRequest& request) {
    Result<dsl::Surface> surface = dsl::make_surface(catalogue, request.surface);
    if (!surface) return false;
    for (const auto& [name, value] : request.knobs)
        if (!surface->set_knob(name, value)) return false;
    return surface->lighting->shadowing() > 1 && surface->shadow->depends_on_light();
}

// The same surface under the shadow that misses nothing.
VariantRequest with_exact_shadow(const dsl::Catalogue& catalogue, VariantRequest request) {
    request.surface = dsl::with_part(request.surface, "shadow", "exact");
    if (Result<dsl::Surface> surface = dsl::make_surface(catalogue, request.surface))
        std::erase_if(request.knobs, [&](const auto& knob) {
            return !surface->set_knob(knob.first, knob.second);
        });
    return request;
}

Result<check::Program> pass_after_search(const dsl::Catalogue& catalogue,
                                         const VariantRequest& request) {
    const Result<Variant> variant = make_variant(catalogue, request);
    if (!variant) return variant.error();
    return link_variant(*variant);
}

// A case's row with its map, ready to be drawn at any view and light.
struct Bench {
    std::string key;
    std::shared_ptr<const Result<CompiledRow>> row;
    std::shared_ptr<const Textures> textures;
    reference::HeightField field;
    // Made when first asked for.
    std::optional<PreparedHits> hits;
    std::optional<vulkan::Program> shaded;
    std::optional<InterpretedQuad> shaded_bytecode;
    std::optional<EvaluatedQuad> evaluated, split;
    std::optional<InterpretedQuad> split_bytecode;

    Maker maker(Arithmetic arithmetic) const {
        if ((*row)->is_bytecode) return Maker::Interpreter;
        return arithmetic == Arithmetic::Fp32 ? Maker::Device : Maker::Evaluator;
    }
};

}  // namespace

struct Laboratory::State {
    const dsl::Catalogue& catalogue;
    vulkan::Device device;
    int threads;
    std::shared_ptr<Shared> shared;
    Bench bench;

    std::string map_key(const Case& what, const CaseMap& map) const {
        return fmt::format("{} {} {} {}", map.hash, what.scale, what.size,
                           static_cast<int>(what.filtering));
    }
    Status set_up(const Case& what, const CaseMap& map);
    Status prepare(const Case& what);
    std::shared_ptr<const ExactPicture> exact(const Case& what, const CaseMap& map, Direction view,
                                              Direction light, int size);
    Result<vulkan::Picture> draw_hits(const Case& what, Direction view, Executed& executed);
    Result<vulkan::Picture> shade(const Case& what, const vulkan::Picture& hits, From from);
    Result<vulkan::Picture> draw_shaded(const Case& what, const CaseHits& hits);
    std::shared_ptr<const Result<vulkan::Picture>> exact_picture(const Case& what,
                                                                 const CaseMap& map,
                                                                 const ExactPicture& exact);
    Result<CaseHits> measure_hits(const Case& what, const CaseMap& map);
    Result<Hits> split_hits(const Case& what, ir::Texture::Weights weights, Executed* executed);
    Result<std::optional<ErrorSplit>> split(const Case& what, const CaseMap& map,
                                            Executed& executed);
    Result<CaseMetrics> measure(const Case& what, const CaseMap& map);
};

// Compiles the row and finds its textures, if the last case was of another.
Status Laboratory::State::set_up(const Case& what, const CaseMap& map) {
    const std::string row = text_of(what.request);
    const std::string key = fmt::format("{} {} {} {}", row, static_cast<int>(what.arithmetic),
                                        what.split_size, map_key(what, map));
    if (bench.key == key) return bench.row->ok() ? Status(Done{}) : Status(bench.row->error());
    bench = {};
    bench.row = shared->rows.get(row, [&] { return compile_row(catalogue, what.request); });
    bench.textures =
        shared->textures.get(fmt::format("{} {}", map.hash, static_cast<int>(what.filtering)),
                             [&] { return Textures(map.set, what.filtering); });
    bench.field = map.set.height_field(reference::FilterWeights::Exact);
    bench.key = key;
    if (!bench.row->ok()) return bench.row->error();
    return Done{};
}

// The programs and quads of the row, with the map.
Status Laboratory::State::prepare(const Case& what) {
    if (bench.hits) return Done{};
    const CompiledRow& row = **bench.row;
    const Textures& textures = *bench.textures;
    if (row.is_bytecode) {
        Result<InterpretedQuad> quad = interpreted(row.shaded_variant, textures, what, what.size);
        if (!quad) return quad.error();
        bench.shaded_bytecode = std::move(*quad);
    } else if (what.arithmetic == Arithmetic::Fp32) {
        Result<vulkan::Program> program =
            prepare_quad(device, row.shaded, textures, what.scale, what.size, what.size);
        if (!program) return program.error();
        bench.shaded = std::move(*program);
    }
    Result<EvaluatedQuad> quad =
        EvaluatedQuad::prepare(row.displaced_variant, textures, what.scale, what.size, what.size);
    if (!quad) return quad.error();
    bench.evaluated = std::move(*quad);
    if (what.split_size > 0) {
        quad = EvaluatedQuad::prepare(row.displaced_variant, textures, what.scale, what.split_size,
                                      what.split_size);
        if (!quad) return quad.error();
        bench.split = std::move(*quad);
        if (row.is_bytecode) {
            Result<InterpretedQuad> bytecode =
                interpreted(row.displaced_variant, textures, what, what.split_size);
            if (!bytecode) return bytecode.error();
            bench.split_bytecode = std::move(*bytecode);
        }
    }
    Result<PreparedHits> hits = bench.maker(what.arithmetic) == Maker::Evaluator
                                    ? PreparedHits{}
                                    : prepare_hits(device, row, textures, what.scale, what.size);
    if (!hits) return hits.error();
    bench.hits = std::move(*hits);
    return Done{};
}

std::shared_ptr<const ExactPicture> Laboratory::State::exact(const Case& what, const CaseMap& map,
                                                             Direction view, Direction light,
                                                             int size) {
    const std::string key =
        fmt::format("{} {} {} {} {} {} {}", map.hash, what.scale, size, view.elevation,
                    view.azimuth, light.elevation, light.azimuth);
    return shared->exact.get(key, [&] {
        return trace_exact(bench.field, view, light, static_cast<float>(what.scale), size, size,
                           threads);
    });
}

Result<vulkan::Picture> Laboratory::State::draw_hits(const Case& what, Direction view,
                                                     Executed& executed) {
    const Maker maker = bench.maker(what.arithmetic);
    if (maker == Maker::Interpreter) {
        const d3d9::Arithmetic unit = unit_of(what.arithmetic);
        Result<InterpretedPicture> drawn =
            bench.hits->quad(unit).draw(view, what.light, unit, threads);
        if (!drawn) return drawn.error();
        executed = {drawn->reads_mean, drawn->reads_max, drawn->instructions_mean,
                    drawn->instructions_max};
        return std::move(drawn->picture);
    }
    if (maker == Maker::Evaluator) {
        const EvaluatedPicture drawn = bench.evaluated->draw(
            view, what.light, precision_of(what.arithmetic),
            bench.textures->height.format == vulkan::Texture::Format::Rgba8Unorm
                ? ir::Texture::Weights::EightBit
                : ir::Texture::Weights::Exact,
            threads);
        executed = {drawn.reads_mean, drawn.reads_max, drawn.instructions_mean,
                    drawn.instructions_max};
        return drawn.picture();
    }
    vulkan::Program& program = *bench.hits->program;
    if (Status status = aim(program, view, what.light); !status) return status.error();
    Result<std::vector<vulkan::Picture>> pictures = program.draw();
    if (!pictures) return pictures.error();
    executed = {};
    for (const std::array<float, 4>& reads : (*pictures)[1].pixels) {
        executed.reads_mean += static_cast<double>(reads[0]);
        executed.reads_max = std::max(executed.reads_max, static_cast<long>(reads[0]));
    }
    executed.reads_mean /= static_cast<double>((*pictures)[1].pixels.size());
    return std::move(pictures->front());
}

Result<CaseHits> Laboratory::State::measure_hits(const Case& what, const CaseMap& map) {
    if (Status status = prepare(what); !status) return status.error();
    CaseHits hits;
    hits.maker = bench.maker(what.arithmetic);
    Result<vulkan::Picture> picture = draw_hits(what, what.view, hits.executed);
    if (!picture) return picture.error();
    hits.picture = std::move(*picture);
    hits.exact = exact(what, map, what.view, what.light, what.size);
    hits.errors = compare_hits(hits.picture, *hits.exact, bench.field, what.view,
                               static_cast<float>(what.scale), threads);
    return hits;
}

Result<vulkan::Picture> Laboratory::State::shade(const Case& what, const vulkan::Picture& hits,
                                                 From from) {
    VariantRequest request = what.request;
    request.target = "glsl_450";
    request.loop_forms.clear();
    request.known = {};
    request.per_vertex = false;
    request.split.shadow = from == From::Shadow;
    request.split.shading = from == From::Shading;
    request.pass = 2;
    const auto program =
        shared->shadings.get(text_of(request) + dsl::to_string(request.split),
                             [&] { return pass_after_search(catalogue, request); });
    if (!*program) return program->error();
    const vulkan::Texture before = offsets_of(hits);
    const PassLink link{&before,
                        vulkan::Texture::Format::Rgba32Float,
                        {{"pixel_place", {0.5f, 0.5f, 0.5f, 0.5f}}, {"colour_to_offset", {1, 0}}}};
    Result<vulkan::Program> draw = prepare_quad(device, **program, *bench.textures, what.scale,
                                                what.size, what.size, {}, link);
    if (!draw) return draw.error();
    if (Status status = aim(*draw, what.view, what.light); !status) return status.error();
    Result<std::vector<vulkan::Picture>> pictures = draw->draw();
    if (!pictures) return pictures.error();
    return std::move(pictures->front());
}

Result<vulkan::Picture> Laboratory::State::draw_shaded(const Case& what, const CaseHits& hits) {
    if (hits.maker == Maker::Evaluator)
        return shade(what, hits.picture,
                     has_several_shadows(catalogue, what.request) ? From::Shadow : From::Shading);
    if (hits.maker == Maker::Interpreter) {
        Result<InterpretedPicture> drawn =
            bench.shaded_bytecode->draw(what.view, what.light, unit_of(what.arithmetic), threads);
        if (!drawn) return drawn.error();
        return std::move(drawn->picture);
    }
    if (Status status = aim(*bench.shaded, what.view, what.light); !status) return status.error();
    Result<std::vector<vulkan::Picture>> pictures = bench.shaded->draw();
    if (!pictures) return pictures.error();
    return std::move(pictures->front());
}

std::shared_ptr<const Result<vulkan::Picture>> Laboratory::State::exact_picture(
    const Case& what, const CaseMap& map, const ExactPicture& exact_hits_there) {
    const bool several = has_several_shadows(catalogue, what.request);
    const From from = bench.evaluated->sees_light() && !several ? From::Shading : From::Shadow;
    Case shaded = what;
    if (several) shaded.request = with_exact_shadow(catalogue, what.request);
    // Surfaces that differ in their search alone share the picture: the pass behind the search is
    // recorded, and tells.
    VariantRequest request = shaded.request;
    request.target = "glsl_450";
    request.loop_forms.clear();
    request.known = {};
    request.split = {1, from == From::Shadow, from == From::Shading};
    request.pass = 2;
    Result<Recorded> pass = record_variant(catalogue, request);
    if (!pass) return std::make_shared<const Result<vulkan::Picture>>(pass.error());
    pass->program.pixel.name.clear();
    const std::string key =
        fmt::format("{} {} {} {} {} {}", map_key(what, map), what.view.elevation, what.view.azimuth,
                    what.light.elevation, what.light.azimuth, ir::print(pass->program.pixel));
    return shared->exact_pictures.get(
        key, [&] { return shade(shaded, exact_hits(exact_hits_there), from); });
}

// The hits of the split's rays in the arithmetic of the case.
Result<Hits> Laboratory::State::split_hits(const Case& what, ir::Texture::Weights weights,
                                           Executed* executed) {
    if (bench.split_bytecode) {
        const Result<InterpretedPicture> drawn = bench.split_bytecode->with_weights(weights).draw(
            what.view, what.light, unit_of(what.arithmetic), threads);
        if (!drawn) return drawn.error();
        return hits_in(drawn->picture);
    }
    EvaluatedPicture drawn =
        bench.split->draw(what.view, what.light, precision_of(what.arithmetic), weights, threads);
    if (executed != nullptr && !executed->instructions_mean) {
        executed->instructions_mean = drawn.instructions_mean;
        executed->instructions_max = drawn.instructions_max;
    }
    return std::move(drawn.pixels);
}

Result<std::optional<ErrorSplit>> Laboratory::State::split(const Case& what, const CaseMap& map,
                                                           Executed& executed) {
    if (what.split_size == 0) return std::optional<ErrorSplit>();
    using Weights = ir::Texture::Weights;
    SplitHits hits;
    const auto in_double = [&](Weights weights) {
        return bench.split->draw(what.view, what.light, ir::Precision::Double, weights, threads)
            .pixels;
    };
    hits.technique = in_double(Weights::Exact);
    hits.filter = in_double(Weights::EightBit);
    Result<Hits> exactly = split_hits(what, Weights::Exact, &executed);
    if (!exactly) return exactly.error();
    hits.arithmetic = std::move(*exactly);
    Result<Hits> total = split_hits(what, Weights::EightBit, nullptr);
    if (!total) return total.error();
    hits.total = std::move(*total);
    const auto right = exact(what, map, what.view, what.light, what.split_size);
    return std::optional(split_error(hits, *right, map.set.heights.width, map.set.heights.height));
}

Result<CaseMetrics> Laboratory::State::measure(const Case& what, const CaseMap& map) {
    CaseMetrics metrics;
    if (Status status = set_up(what, map); !status) {
        if (status.error().fault == Fault::Internal) return status.error();
        metrics.refusal = status.error();
        return metrics;
    }
    const Result<CaseHits> hits = measure_hits(what, map);
    if (!hits) return hits.error();
    const CompiledRow& row = **bench.row;
    metrics.maker = hits->maker;
    metrics.settings = row.settings;
    metrics.spirv = row.cost;
    metrics.slots = row.slots;
    metrics.executed = hits->executed;
    metrics.hits = summarize(hits->errors, what.size);
    metrics.worst = pixel_of(*hits, what.view, metrics.hits.worst_x, metrics.hits.worst_y);

    const Direction moved = moved_view(what.view);
    Executed ignored;
    const Result<vulkan::Picture> after = draw_hits(what, moved, ignored);
    if (!after) return after.error();
    // The light does not matter here: straight above it is traced at once.
    metrics.swim =
        swim_of(hits->picture, *after, *hits->exact, *exact(what, map, moved, {90, 0}, what.size),
                map.set.heights.width, map.set.heights.height);

    const Result<vulkan::Picture> shaded = draw_shaded(what, *hits);
    if (!shaded) return shaded.error();
    const auto right = exact_picture(what, map, *hits->exact);
    if (!*right) return right->error();
    metrics.picture = compare_pictures(**right, *shaded);

    const Result<std::optional<ErrorSplit>> parts = split(what, map, metrics.executed);
    if (!parts) return parts.error();
    metrics.split = *parts;
    if (const std::vector<std::string> messages = device.validation_messages(); !messages.empty())
        return internal_error("vulkan-validation",
                              "the Vulkan validation layer complains: " + messages.front());
    return metrics;
}

Result<Laboratory> Laboratory::create(const dsl::Catalogue& catalogue,
                                      const LaboratoryOptions& options,
                                      std::shared_ptr<Shared> shared) {
    Result<vulkan::Device> device = vulkan::Device::create({options.device, options.validation});
    if (!device) return device.error();
    return Laboratory(std::unique_ptr<State>(
        new State{catalogue, std::move(*device), options.threads, std::move(shared), {}}));
}

std::string Laboratory::device() const {
    return fmt::format("{}, {}", state_->device.name(), state_->device.driver());
}

Result<CaseMetrics> Laboratory::measure(const Case& what, const CaseMap& map) {
    return state_->measure(what, map);
}

Result<CaseHits> Laboratory::hits(const Case& what, const CaseMap& map) {
    if (Status status = state_->set_up(what, map); !status) return status.error();
    return state_->measure_hits(what, map);
}

Result<Laboratory::Pictures> Laboratory::pictures(const Case& what, const CaseMap& map) {
    const Result<CaseHits> there = hits(what, map);
    if (!there) return there.error();
    Result<vulkan::Picture> drawn = state_->draw_shaded(what, *there);
    if (!drawn) return drawn.error();
    return Pictures{std::move(*drawn), state_->exact_picture(what, map, *there->exact)};
}

Laboratory::Laboratory(std::unique_ptr<State> state) : state_(std::move(state)) {}
Laboratory::Laboratory(Laboratory&&) noexcept = default;
Laboratory& Laboratory::operator=(Laboratory&&) noexcept = default;
Laboratory::~Laboratory() = default;

WorstPixel pixel_of(const CaseHits& hits, Direction view, int x, int y) {
    WorstPixel pixel;
    const std::size_t i = static_cast<std::size_t>(y * hits.exact->width + x);
    const reference::Hit& exact = hits.exact->hits[i];
    const std::array<float, 4>& reported = hits.picture.pixels[i];
    const std::array<float, 3> v = vector_of(view);
    pixel.x = x;
    pixel.y = y;
    pixel.texels = static_cast<double>(hits.errors[i].texels);
    pixel.missed = hits.errors[i].missed;
    pixel.uv = {(x + 0.5) / hits.exact->width, (y + 0.5) / hits.exact->height};
    std::copy(v.begin(), v.end(), pixel.view.begin());
    pixel.exact = {exact.uv.x, exact.uv.y, exact.height};
    std::copy_n(reported.begin(), 3, pixel.reported.begin());
    return pixel;
}

}  // namespace intaglio::measure
