// Shells: layers of the polygon, one above the other, each showing only where the height map
// reaches it.  Lengyel, Praun, Finkelstein and Hoppe, "Real-Time Fur over Arbitrary Surfaces",
// 2001: the rival of the march through a height field, which the steep parallax abstract calls
// slower.
//
// Layer i of N lies at height i / N, from the floor up, and is kept where the map is at least that
// high.  Along a view ray those are the samples of a march in N equal steps, but every one of them
// is a fragment: the fragments do not know that the ray has met the relief above.
//
// Fins, from the same paper, close the gaps that layers leave where they are seen edge on: below
// each edge of the mesh stands a strip down to the floor, kept where the relief reaches it and the
// surface is seen from less than `fin_view` above.  Every point of it lies inside the relief, so a
// fin shows nothing that the relief does not hide.
#pragma once

#include "generator/dsl/catalogue.h"
#include "src/measure/render.h"
#include "src/variant/variant.h"

namespace intaglio::measure {

// search=shells and vertex=shells; see with_geometry.
void add_shells(dsl::Catalogue& catalogue);

// The request of a surface with its search and vertex work replaced by those of N shells, which
// are drawn with clipping on.  `counting`: every fragment of one layer and no other, see
// count_overdraw.
// Fins need a request of their own, with_fins.
VariantRequest shells_request(VariantRequest request, int layers, bool counting = false);
VariantRequest with_fins(VariantRequest request);

// N copies of the mesh, the deepest first, each moved down its normal by (1 - its height) * depth;
// depth in world units.  The size of tangent.w is 1 + height, its sign the handedness: for
// vertex=shells only.  Errors: "layers": not 1 to 512; those of check_mesh_size.
Result<vulkan::Mesh> shells_of(const vulkan::Mesh& mesh, int layers, double depth);
// Adds to the shells of a mesh a fin for each of its edges: four vertices, the size of tangent.w
// 3 + height.  Errors: those of check_mesh_size.
Result<vulkan::Mesh> add_fins(vulkan::Mesh shells, const vulkan::Mesh& mesh, double depth);

// What prepare_mesh and prepare_parallel do not know of shells: a link to prepare with, and what is
// set once before the first draw.
PassLink shells_link();
Status set_shells(vulkan::Program& program);

// Fragments shaded at each pixel.  Drawn from the floor up no depth test spares one, and blending
// allows no other order.  Each layer is drawn alone and its pixels counted, so that of a closed
// mesh only the half counts that a renderer keeps which culls back faces.  Fins, which overlap each
// other, are not counted.  `program`: of a counting
// request.
Result<std::vector<int>> count_overdraw(vulkan::Program& program, int layers);

}  // namespace intaglio::measure
