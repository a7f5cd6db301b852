// march: vertex stage for ps_3_0
// March the view ray down until a sample rises above it.
// Settings: taps = 8

// texcoord0.xy uv
// texcoord1.xyz view

//    3 of 512  slots in total
//    1 of 256  float constants
//    1 of 16   input registers
//    3 of 12   output registers

vs_3_0
def c0, 0, 1, 0, 0
dcl_position v0.xyz
dcl_position o0
dcl_texcoord o1.xy
dcl_texcoord1 o2.xyz
// Beside each instruction: slots so far, arithmetic and texture; its step and line.
mad o0, v0.xyzx, c0.yyyx, c0.xxxy                ;   1   0
mov o1.xy, v0.x                                  ;   2   0
mov o2.xyz, v0.x                                 ;   3   0
