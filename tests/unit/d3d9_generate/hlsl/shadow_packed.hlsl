// A shadow march of 8 steps from the point that a first pass found: point, and whether it is lit.
// Four differences in one, and the greatest of them, with STOPS of those below the top of the relief;
// heights lie in [0, 1], so that the top stops nothing.
sampler2D height_map : register(s0);
sampler2D first_pass : register(s1);
float scale;

float4 main(float2 uv : TEXCOORD0, float3 to_light : TEXCOORD1) : COLOR {
    float4 hit = tex2D(first_pass, uv);
    float3 light = to_light * rsqrt(max(dot(to_light, to_light), 1e-18));
    float2 reach = light.xy / max(light.z, 1.0 / 1024) * scale;
    float h1 = tex2D(height_map, hit.xy + reach * (1 / 8.0)).x;
    float h2 = tex2D(height_map, hit.xy + reach * (2 / 8.0)).x;
    float h3 = tex2D(height_map, hit.xy + reach * (3 / 8.0)).x;
    float h4 = tex2D(height_map, hit.xy + reach * (4 / 8.0)).x;
    float h5 = tex2D(height_map, hit.xy + reach * (5 / 8.0)).x;
    float h6 = tex2D(height_map, hit.xy + reach * (6 / 8.0)).x;
    float h7 = tex2D(height_map, hit.xy + reach * (7 / 8.0)).x;
    float h8 = tex2D(height_map, hit.xy + reach * (8 / 8.0)).x;
    float4 g0 = float4(h1, h2, h3, h4) - float4(1.1, 2.1, 3.1, 4.1) / 8;
    float4 g1 = float4(h5, h6, h7, h8) - float4(5.1, 6.1, 7.1, 8.1) / 8;
#ifdef STOPS
    g0 = hit.z + float4(0.1, 1.1, 2.1, 3.1) / 8 >= 1 ? -1 : g0;
    g1 = hit.z + float4(4.1, 5.1, 6.1, 7.1) / 8 >= 1 ? -1 : g1;
#endif
    float4 four = max(g0, g1);
    float2 two = max(four.xy, four.wz);
    float most = max(two.x, two.y) - hit.z;
    return float4(hit.xyz, max(most, -light.z) < 0 ? 1 : 0);
}
