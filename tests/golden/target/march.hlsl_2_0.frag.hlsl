// march: pixel stage for hlsl_2_0
// March the view ray down until a sample rises above it.
// Settings: taps = 8

float scale;  // depth of the relief in texture units

sampler2D height_map : register(s0);  // height in red: 1 is the polygon, 0 the deepest

struct Interpolants {
    float2 uv : TEXCOORD0;
    float3 view : TEXCOORD1;
};

float4 pixel_main(Interpolants pixel) : SV_Target0 {
    float2 reach = pixel.view.xy / pixel.view.z * scale;

    // Walk down the ray until a sample of the height profile rises above it.
    float difference = tex2D(height_map, pixel.uv).x - 1.0;
    bool condition = difference >= 0.0;
    float2 at = pixel.uv - reach * 0.125;
    float difference_2 = tex2D(height_map, at).x - 0.875;
    bool condition_2 = difference_2 >= 0.0;
    float2 at_2 = pixel.uv - reach * 0.25;
    float difference_3 = tex2D(height_map, at_2).x - 0.75;
    bool condition_3 = difference_3 >= 0.0;
    float2 at_3 = pixel.uv - reach * 0.375;
    float difference_4 = tex2D(height_map, at_3).x - 0.625;
    bool condition_4 = difference_4 >= 0.0;
    float2 at_4 = pixel.uv - reach * 0.5;
    float difference_5 = tex2D(height_map, at_4).x - 0.5;
    bool condition_5 = difference_5 >= 0.0;
    float2 at_5 = pixel.uv - reach * 0.625;
    float difference_6 = tex2D(height_map, at_5).x - 0.375;
    bool condition_6 = difference_6 >= 0.0;
    float2 at_6 = pixel.uv - reach * 0.75;
    float difference_7 = tex2D(height_map, at_6).x - 0.25;
    bool condition_7 = difference_7 >= 0.0;
    float2 at_7 = pixel.uv - reach * 0.875;
    float difference_8 = tex2D(height_map, at_7).x - 0.125;
    bool condition_8 = difference_8 >= 0.0;
    float2 at_8 = pixel.uv - reach;
    float4 texel = tex2D(height_map, at_8);
    float chosen = condition ? difference : condition_2 ? difference_2 : condition_3 ? difference_3
        : condition_4 ? difference_4 : condition_5 ? difference_5 : condition_6 ? difference_6
        : condition_7 ? difference_7 : condition_8 ? difference_8 : texel.x;

    // Show how deep the ray went.
    float depth = (condition ? 0.0 : condition_2 ? 0.125 : condition_3 ? 0.25 : condition_4 ? 0.375
        : condition_5 ? 0.5 : condition_6 ? 0.625 : condition_7 ? 0.75 : condition_8 ? 0.875 : 1.0)
        - 0.125
        * (chosen
        / (chosen
        - (condition ? difference : condition_2 ? difference : condition_3 ? difference_2
        : condition_4 ? difference_3 : condition_5 ? difference_4 : condition_6 ? difference_5
        : condition_7 ? difference_6 : condition_8 ? difference_7 : difference_8)));
    return float4((float3)depth, 1.0);
}
