#version 300 es

// march: vertex stage for essl_300
// March the view ray down until a sample rises above it.
// Settings: taps = 8

precision highp float;
precision highp int;
precision highp sampler2D;

layout(location = 0) in vec3 vertex_position;

out vec2 uv;
out vec3 view;

void main() {
    gl_Position = vec4(vertex_position, 1.0);
    uv = vertex_position.xx;
    view = vertex_position.xxx;
}
