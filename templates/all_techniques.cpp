// The tables.
#include "templates/all_techniques.h"

namespace intaglio::templates {

dsl::Catalogue all_techniques() {
    return {
        .searches = {search_none(), search_parallax(), search_parallax_limited(),
                     search_parallax_iterative(), search_steep_parallax(),
                     search_parallax_occlusion(), search_relief(), search_relief_secant(),
                     search_contact_refinement(), search_distance(), search_cone(),
                     search_cone_relaxed(), search_max_mip(), search_view_dependent(),
                     search_exact()},
        .shadows = {shadow_none(), shadow_march(), shadow_soft(), shadow_occlusion_profile(),
                    shadow_horizon(), shadow_exact(), shadow_fur_depth()},
        .normals = {normal_map(), normal_blinn(), normal_smoothed(), normal_from_hit()},
        .shadings = {shading_phong(), shading_lambert(), shading_phong_map(), shading_emboss(),
                     shading_ambient_only()},
        .outputs = {output_colour(), output_displaced(), output_depth()},
        .vertex_works = {vertex_tangent_space()},
        .presets =
            {
                {"bump", "search=none"},
                {"blinn", "search=none,normal=blinn"},
                {"emboss", "search=none,shading=emboss"},
                {"fur", "search=steep_parallax,shadow=fur_depth"},
                {"parallax_occlusion_chapter",
                 "search=parallax_occlusion,shadow=occlusion_profile"},
                {"parallax_occlusion_soft", "search=parallax_occlusion,shadow=soft"},
                {"steep_parallax_shadowed", "search=steep_parallax,shadow=march"},
            },
    };
}

}  // namespace intaglio::templates
