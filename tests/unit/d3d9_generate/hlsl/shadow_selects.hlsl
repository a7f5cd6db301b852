// A shadow march of 8 steps from the point that a first pass found: point, and whether it is lit.
// One select for each step.
sampler2D height_map : register(s0);
sampler2D first_pass : register(s1);
float scale;

float4 main(float2 uv : TEXCOORD0, float3 to_light : TEXCOORD1) : COLOR {
    float4 hit = tex2D(first_pass, uv);
    float3 light = to_light * rsqrt(max(dot(to_light, to_light), 1e-18));
    float2 reach = light.xy / max(light.z, 1.0 / 1024) * scale;
    float lit = light.z > 0 ? 1 : 0;
    [unroll] for (int i = 1; i <= 8; ++i)
        lit = tex2D(height_map, hit.xy + reach * (i / 8.0)).x - (i + 0.1) / 8 >= hit.z ? 0 : lit;
    return float4(hit.xyz, lit);
}
