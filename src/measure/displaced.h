// Displaced geometry: the height field as triangles, drawn by the runner.  A second ground truth
// beside src/reference, which shares nothing with it: a rasteriser finds what is nearest, and
// silhouettes come out as they are.
//
// Within a cell of four texels the surface is a bilinear patch; cut into k x k squares of two
// triangles each, it differs from the triangles by at most |h00 - h10 - h01 + h11| / (4 k^2) in
// height.
#pragma once

#include "generator/dsl/catalogue.h"
#include "src/measure/render.h"
#include "src/reference/height_field.h"

namespace intaglio::measure {

// The lines of a grid that follow the texels: `first`, `last`, and between them every texel centre
// (where the patches meet) of a map that is repeated `repeat` times from 0 to 1, with
// `subdivisions` squares from one to the next.  Error "grid-size": subdivisions outside 1 to 64, or
// more than 2^22 lines.
Result<std::vector<double>> texel_lines(double first, double last, int texels, double repeat,
                                        int subdivisions);

// Error "mesh-size" where geometry has more than 2^23 vertices.
Status check_mesh_size(std::size_t vertices);

// Moves every vertex down its normal by (1 - height) * depth, the heights those of the map at its
// texture coordinate.  `depth` in world units: the relief's scale times what a texture unit spans.
// Errors: check_mesh_size.
Result<vulkan::Mesh> displace(vulkan::Mesh mesh, const reference::HeightField& field, double depth);

// What the geometry that the runner draws needs of a surface, as techniques of their own:
//   search=displaced: the coordinate stays, the height is the map's there
//   search=shells, vertex=shells: see shells.h
dsl::Catalogue with_geometry(const dsl::Catalogue& catalogue);

// Parallel rays in place of an eye: pixel (x, y) of a W by H picture looks along the ray that meets
// the plane z = 0 at ((x + 0.5) / W, (y + 0.5) / H), as prepare_quad's do.  The mesh reaches from
// z = 0 down to -depth.  Error "view-below": the view is not from above.
Result<vulkan::Camera> parallel_camera(Direction view, double depth);

// A mesh below the unit square under a parallel camera.  What a view needs beyond the square's
// edges the mesh must have.
Result<vulkan::Program> prepare_parallel(const vulkan::Device& device,
                                         const check::Program& shaders, const Textures& textures,
                                         double scale, int width, int height,
                                         const vulkan::Mesh& mesh, Direction view, Direction light,
                                         const PassLink& link = {}, const Look& look = {});

// How far a view ray travels over the map, in texture units along either axis: how much wider than
// the picture the mesh must be on each side.
double reach_of(Direction view, double scale);

// The height field below the unit square and `margin` texture units around it, for
// prepare_parallel; z from -scale to 0.
Result<vulkan::Mesh> displaced_map(const reference::HeightField& field, double scale,
                                   int subdivisions, double margin);

}  // namespace intaglio::measure
