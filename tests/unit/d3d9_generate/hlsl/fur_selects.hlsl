// Fur in 12 steps, where the ray vector is interpolated: displaced coordinate, height, light left there.
// One select for each step, from the last to the first, then the height again.
sampler2D height_map : register(s0);

float4 main(float4 place : TEXCOORD0) : COLOR {
    float2 uv = place.xy, reach = place.wz;
    float key = 0;
    [unroll] for (int i = 11; i >= 0; --i)
        key = tex2D(height_map, uv - reach * (i / 12.0)).x >= 1 - i / 12.0 ? 1 - i / 12.0 : key;
    float2 displaced = uv - reach * (1 - key);
    float height = tex2D(height_map, displaced).x;
    return float4(displaced, height, lerp(0.25, 1, height));
}
