// Fur in 12 steps, where the ray vector is interpolated: displaced coordinate, height, light left there.
// As the paper writes it.
sampler2D height_map : register(s0);

float4 main(float4 place : TEXCOORD0) : COLOR {
    float2 uv = place.xy, reach = place.wz;
    float t = 0, height = tex2D(height_map, uv).x;
    [unroll] for (int i = 0; i < 12; ++i) {
        if (height < 1 - t) {
            t = (i + 1) / 12.0;
            height = tex2D(height_map, uv - reach * t).x;
        }
    }
    return float4(uv - reach * t, height, lerp(0.25, 1, height));
}
