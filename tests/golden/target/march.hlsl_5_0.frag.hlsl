// march: pixel stage for hlsl_5_0
// March the view ray down until a sample rises above it.
// Settings: taps = 8

cbuffer PixelUniforms : register(b1) {
    float scale;  // depth of the relief in texture units
};

Texture2D height_map : register(t0);  // height in red: 1 is the polygon, 0 the deepest
SamplerState height_map_sampler : register(s0);

struct Interpolants {
    float2 uv : TEXCOORD0;
    float3 view : TEXCOORD1;
    float4 clip_value : SV_Position;
};

float4 pixel_main(Interpolants pixel) : SV_Target0 {
    float2 reach = pixel.view.xy / pixel.view.z * scale;

    // Walk down the ray until a sample of the height profile rises above it.
    float above = height_map.SampleLevel(height_map_sampler, pixel.uv, 0.0).x - 1.0;
    float t = 0.0;
    float below = above;
    [loop] for (int i = 0; i < 8; ++i) {
        if (below >= 0.0) break;
        t = float(i + 1) * 0.125;
        precise float2 at = pixel.uv - reach * t;
        above = below;
        below = height_map.SampleLevel(height_map_sampler, at, 0.0).x - (1.0 - t);
    }

    // Show how deep the ray went.
    float depth = t - 0.125 * (below / (below - above));
    precise float4 colour = float4((float3)depth, 1.0);
    return colour;
}
