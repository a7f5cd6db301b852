#version 100

// march: vertex stage for essl_100
// March the view ray down until a sample rises above it.
// Settings: taps = 8

precision highp float;
precision highp int;
precision highp sampler2D;

attribute vec3 vertex_position;

varying vec2 uv;
varying vec3 view;

void main() {
    gl_Position = vec4(vertex_position, 1.0);
    uv = vertex_position.xx;
    view = vertex_position.xxx;
}
