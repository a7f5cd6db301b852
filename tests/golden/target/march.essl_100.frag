#version 100
#extension GL_EXT_shader_texture_lod : require

// march: pixel stage for essl_100
// March the view ray down until a sample rises above it.
// Settings: taps = 8

precision highp float;
precision highp int;
precision highp sampler2D;

varying vec2 uv;
varying vec3 view;

uniform float scale;  // depth of the relief in texture units
uniform sampler2D height_map;  // height in red: 1 is the polygon, 0 the deepest

void main() {
    vec2 reach = view.xy / view.z * scale;

    // Walk down the ray until a sample of the height profile rises above it.
    float above = texture2DLodEXT(height_map, uv, 0.0).x - 1.0;
    float t = 0.0;
    float below = above;
    for (int i = 0; i < 8; i++) {
        if (below >= 0.0) break;
        t = float(i + 1) * 0.125;
        vec2 at = uv - reach * t;
        above = below;
        below = texture2DLodEXT(height_map, at, 0.0).x - (1.0 - t);
    }

    // Show how deep the ray went.
    float depth = t - 0.125 * (below / (below - above));
    gl_FragColor = vec4(vec3(depth), 1.0);
}
