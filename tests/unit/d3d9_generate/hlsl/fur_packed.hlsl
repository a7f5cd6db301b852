// Fur in 12 steps, where the ray vector is interpolated: displaced coordinate, height, light left there.
// The generator's own lowering written by hand: four compares in one, the greatest key, the height again.
sampler2D height_map : register(s0);

float4 main(float4 place : TEXCOORD0) : COLOR {
    float2 uv = place.xy, reach = place.wz;
    float h0 = tex2D(height_map, uv - reach * (0 / 12.0)).x;
    float h1 = tex2D(height_map, uv - reach * (1 / 12.0)).x;
    float h2 = tex2D(height_map, uv - reach * (2 / 12.0)).x;
    float h3 = tex2D(height_map, uv - reach * (3 / 12.0)).x;
    float h4 = tex2D(height_map, uv - reach * (4 / 12.0)).x;
    float h5 = tex2D(height_map, uv - reach * (5 / 12.0)).x;
    float h6 = tex2D(height_map, uv - reach * (6 / 12.0)).x;
    float h7 = tex2D(height_map, uv - reach * (7 / 12.0)).x;
    float h8 = tex2D(height_map, uv - reach * (8 / 12.0)).x;
    float h9 = tex2D(height_map, uv - reach * (9 / 12.0)).x;
    float h10 = tex2D(height_map, uv - reach * (10 / 12.0)).x;
    float h11 = tex2D(height_map, uv - reach * (11 / 12.0)).x;
    float4 k0 = float4(12, 11, 10, 9) / 12;
    float4 g0 = float4(h0, h1, h2, h3) - k0;
    g0 = g0 >= 0 ? k0 : g0;
    float4 k1 = float4(8, 7, 6, 5) / 12;
    float4 g1 = float4(h4, h5, h6, h7) - k1;
    g1 = g1 >= 0 ? k1 : g1;
    float4 k2 = float4(4, 3, 2, 1) / 12;
    float4 g2 = float4(h8, h9, h10, h11) - k2;
    g2 = g2 >= 0 ? k2 : g2;
    float4 four = max(max(g0, g1), g2);
    float2 two = max(four.xy, four.wz);
    float key = saturate(max(two.x, two.y));
    float2 displaced = uv - reach * (1 - key);
    float height = tex2D(height_map, displaced).x;
    return float4(displaced, height, lerp(0.25, 1, height));
}
