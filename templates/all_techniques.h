// The table of Intaglio's own techniques; one function per file of templates/, which gives its row.
#pragma once

#include "generator/dsl/catalogue.h"

namespace intaglio::templates {

dsl::Entry<dsl::Search> search_none();
dsl::Entry<dsl::Search> search_parallax();
dsl::Entry<dsl::Search> search_parallax_limited();
dsl::Entry<dsl::Search> search_parallax_iterative();
dsl::Entry<dsl::Search> search_steep_parallax();
dsl::Entry<dsl::Search> search_parallax_occlusion();
dsl::Entry<dsl::Search> search_relief();
dsl::Entry<dsl::Search> search_relief_secant();
dsl::Entry<dsl::Search> search_contact_refinement();
dsl::Entry<dsl::Search> search_distance();
dsl::Entry<dsl::Search> search_cone();
dsl::Entry<dsl::Search> search_cone_relaxed();
dsl::Entry<dsl::Search> search_max_mip();
dsl::Entry<dsl::Search> search_view_dependent();
dsl::Entry<dsl::Search> search_exact();
dsl::Entry<dsl::Shadow> shadow_none();
dsl::Entry<dsl::Shadow> shadow_march();
dsl::Entry<dsl::Shadow> shadow_soft();
dsl::Entry<dsl::Shadow> shadow_occlusion_profile();
dsl::Entry<dsl::Shadow> shadow_horizon();
dsl::Entry<dsl::Shadow> shadow_exact();
dsl::Entry<dsl::Shadow> shadow_fur_depth();
dsl::Entry<dsl::NormalSource> normal_map();
dsl::Entry<dsl::NormalSource> normal_blinn();
dsl::Entry<dsl::NormalSource> normal_smoothed();
dsl::Entry<dsl::NormalSource> normal_from_hit();
dsl::Entry<dsl::Shading> shading_phong();
dsl::Entry<dsl::Shading> shading_lambert();
dsl::Entry<dsl::Shading> shading_phong_map();
dsl::Entry<dsl::Shading> shading_emboss();
dsl::Entry<dsl::Shading> shading_ambient_only();
dsl::Entry<dsl::Output> output_colour();
dsl::Entry<dsl::Output> output_displaced();
dsl::Entry<dsl::Output> output_depth();
dsl::Entry<dsl::VertexWork> vertex_tangent_space();

// The first row of each table is what a composition gets that does not name its part.
dsl::Catalogue all_techniques();

}  // namespace intaglio::templates
