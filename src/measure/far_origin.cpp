// A hit's height says where on the ray it is: coordinates themselves would be rounded once more.
#include "src/measure/far_origin.h"

#include <cmath>

#include "src/measure/lone_pixel.h"

namespace intaglio::measure {
namespace {

constexpr double scale = 0.08;
constexpr std::array<double, 3> eye = {0.75, 0.5625, 0.3125};
constexpr double step = 1.0 / 128;

// The greatest movement over places all over the tile.
double movement(const LonePixel& pixel, const FarPlace& far) {
    double most = 0;
    for (int i = 1; i <= 32; ++i) {
        const std::array<double, 2> near = {(i * 37 % 128) * step, (i * 59 % 128) * step};
        const auto height = [&](double tiles) {
            return pixel.at({near[0] + tiles, near[1] + tiles}, eye, {0, 0, 1}, step,
                            far.precision)[2];
        };
        most = std::max(most, std::abs(height(far.tiles) - height(0)));
    }
    return most * std::hypot(eye[0], eye[1]) / eye[2] * scale * 1024;
}

}  // namespace

Result<std::vector<FarRow>> far_rows(const dsl::Catalogue& catalogue) {
    Result<MapSet> map = make_map_set("smooth", 64, 64, scale);
    if (!map) return map.error();
    const Textures textures(*map, Filtering::Float);
    std::vector<FarRow> rows;
    for (const dsl::Entry<dsl::Search>& search : catalogue.searches) {
        FarRow row{search.name, {}, {}};
        for (const bool local : {false, true}) {
            VariantRequest request;
            request.surface = "search=" + search.name + ",output=displaced";
            request.target = "glsl_450";
            if (local) request.knobs = {{"local_origin", "1"}};
            const Result<LonePixel> pixel = LonePixel::prepare(catalogue, request, textures, scale);
            if (!pixel) return pixel.error();
            for (std::size_t i = 0; i < far_places.size(); ++i)
                (local ? row.with : row.without)[i] = movement(*pixel, far_places[i]);
        }
        rows.push_back(std::move(row));
    }
    return rows;
}

Result<std::vector<FarCost>> far_costs(const dsl::Catalogue& catalogue) {
    std::vector<FarCost> costs;
    for (const char* surface : {"parallax", "parallax_occlusion"})
        for (const char* target : {"ps_2_0", "ps_2_b", "ps_3_0"}) {
            FarCost cost{surface, target, {}};
            for (std::size_t form = 0; form < cost.slots.size(); ++form) {
                VariantRequest request;
                request.surface = surface;
                request.target = target;
                request.knobs = {{"local_origin", std::to_string(form)}};
                const Result<Variant> variant = make_variant(catalogue, request);
                if (!variant && is_refusal(variant.error())) continue;
                if (!variant) return variant.error();
                const Result<d3d9::Shader> shader = decode_stage(*variant, ir::Stage::Pixel);
                if (!shader) return shader.error();
                cost.slots[form] = d3d9::count(*shader).arithmetic;
            }
            costs.push_back(std::move(cost));
        }
    return costs;
}

}  // namespace intaglio::measure
