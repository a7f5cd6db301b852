// The displaced coordinate and the height there: what a first pass hands to a second, and what is measured.
#include "templates/all_techniques.h"

namespace intaglio::templates {
namespace {

using namespace dsl;

class Displaced : public Output {
  public:
    std::string name() const override { return "displaced"; }
    bool shaded() const override { return false; }
    float4 write(const Hit& hit, float3) const override { return {hit.uv, hit.height, 1.0f}; }
};

}  // namespace

dsl::Entry<dsl::Output> output_displaced() {
    return dsl::entry<dsl::Output, Displaced>("displaced", "Displaced coordinate in xy, height in z", "");
}

}  // namespace intaglio::templates
