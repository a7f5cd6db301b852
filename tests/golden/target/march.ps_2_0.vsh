// march: vertex stage for ps_2_0
// March the view ray down until a sample rises above it.
// Settings: taps = 8

// texcoord0.xy uv
// texcoord1.xyz view

//    3 of 256  slots in total
//    1 of 256  float constants
//    1 of 16   input registers
//    2 of 8    texture coordinate outputs

vs_2_0
def c0, 0, 1, 0, 0
dcl_position v0
// Beside each instruction: slots so far, arithmetic and texture; its step and line.
mad oPos, v0.xyzx, c0.yyyx, c0.xxxy              ;   1   0
mov oT0.xy, v0.x                                 ;   2   0
mov oT1.xyz, v0.x                                ;   3   0
