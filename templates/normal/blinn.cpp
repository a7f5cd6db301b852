// Blinn's bump mapping with the slopes taken from the height map at run time: no normal map, a
// height per texel is enough.  Blinn, "Simulation of Wrinkled Surfaces", SIGGRAPH 1978, with the
// finite differences of the course notes.
//
// The displaced surface P + h N has the normal P'_s x P'_t.  The notes arrive at
//     N' = N - h_s P_s - h_t P_t,
// which holds for unit tangents at right angles.  For tangents of any length and angle the same
// product, kept whole, is
//     N' = |det| N - sign(det) scale ((h_s t_y - h_t s_y) T + (h_t s_x - h_s t_x) B),
// with P_s = s_x T + s_y B, P_t = t_x T + t_y B and det = s_x t_y - s_y t_x: the notes' formula
// with the tangents replaced by their dual vectors.  A mirrored parametrisation (det < 0) keeps its
// normal outside.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class Blinn : public NormalSource {
  public:
    Knob<int> central{this,       "central",
                      1,          at_least{0},
                      at_most{1}, "1: central differences, four reads; 0: forward ones, three"};
    Knob<float> distance{this,        "difference",
                         1.0f,        at_least{0.125},
                         at_most{64}, "distance of the heights that are compared, in texels"};
    Knob<int> tangents{
        this,        "tangents", 0,
        at_least{0}, at_most{1}, "1: the map is stretched or sheared as uniform map_tangents says"};

    float3 normal(const Relief& relief, const Hit& hit, const Footprint& footprint) const override {
        const auto height = [&](float2 uv) {
            return relief.height_of(relief.map.sample_grad(uv, footprint.ddx_uv, footprint.ddy_uv));
        };
        const float2 step = let("difference", float2(distance.value()) / relief.map_size);
        const float2 along_u(step.x(), 0.0f), along_v(0.0f, step.y());
        const float1 here = central.value() == 1 ? float1(0.0f) : height(hit.uv);
        const auto rise = [&](float2 along) {
            return height(hit.uv + along) - (central.value() == 1 ? height(hit.uv - along) : here);
        };
        const float per_distance = (central.value() == 1 ? 0.5f : 1.0f) / distance.value();
        const float2 slope = let("slope", float2(rise(along_u), rise(along_v)) * relief.map_size *
                                              (relief.scale * per_distance));
        if (tangents.value() == 0) return normalize(let("bumped", float3(-slope, 1.0f)));
        return on_tangents(slope);
    }

  private:
    static float3 on_tangents(float2 slope) {
        const float4 given = uniform<4>(
            "map_tangents",
            "dP/du in xy and dP/dv in zw: along tangent and bitangent, per texture unit");
        const float2 s = given.xy(), t = given.zw();
        const float1 area = let("area", s.x() * t.y() - s.y() * t.x());
        const float1 side = let("side", select(area < 0.0f, float1(-1.0f), 1.0f));
        const float2 tilt = let("tilt", float2(slope.x() * t.y() - slope.y() * s.y(),
                                               slope.y() * s.x() - slope.x() * t.x()) *
                                            side);
        // A map without area has no slopes: the polygon's own normal.
        const bool1 flat = abs(area) <= tiny;
        return normalize(let("bumped", float3(select(flat, float2(0.0f, 0.0f), -tilt),
                                              select(flat, float1(1.0f), abs(area)))));
    }
};

}  // namespace

dsl::Entry<dsl::NormalSource> normal_blinn() {
    return dsl::entry<dsl::NormalSource, Blinn>(
        "blinn", "Normals from differences of the height map, taken at run time", "Blinn 1978");
}

}  // namespace intaglio::templates
