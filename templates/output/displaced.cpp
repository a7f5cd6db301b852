// The displaced coordinate, the height there and whether the light reaches it: what a first pass
// hands to a second (Brawley and Tatarchuk 2004 keep the shadow in alpha), and what is measured.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class Displaced : public Output {
  public:
    std::string name() const override { return "displaced"; }
    bool shaded() const override { return false; }
    float4 write(const Hit& hit, float1 visibility, float3) const override {
        return {hit.uv, hit.height, visibility};
    }
};

}  // namespace

dsl::Entry<dsl::Output> output_displaced() {
    return dsl::entry<dsl::Output, Displaced>(
        "displaced", "Displaced coordinate in xy, height in z, visibility of the light in w", "");
}

}  // namespace intaglio::templates
