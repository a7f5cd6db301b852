// march: vertex stage for hlsl_2_b
// March the view ray down until a sample rises above it.
// Settings: taps = 8

struct Attributes {
    float3 position : POSITION;
};

struct Interpolants {
    float2 uv : TEXCOORD0;
    float3 view : TEXCOORD1;
    float4 clip_value : SV_Position;
};

Interpolants vertex_main(Attributes vertex) {
    Interpolants result;
    result.clip_value = float4(vertex.position, 1.0);
    result.uv = vertex.position.xx;
    result.view = vertex.position.xxx;
    return result;
}
