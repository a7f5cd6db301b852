// A shadow march of 8 steps from the point that a first pass found: point, and whether it is lit.
// As the paper writes it.
sampler2D height_map : register(s0);
sampler2D first_pass : register(s1);
float scale;

float4 main(float2 uv : TEXCOORD0, float3 to_light : TEXCOORD1) : COLOR {
    float4 hit = tex2D(first_pass, uv);
    float3 light = to_light * rsqrt(max(dot(to_light, to_light), 1e-18));
    float2 reach = light.xy / max(light.z, 1.0 / 1024) * scale;
    float rise = 0.1 / 8, height = hit.z, done = 0;
    [unroll] for (int i = 0; i < 8; ++i) {
        float ray = hit.z + rise;
        if (done == 0) {
            if (height >= ray || ray >= 1) {
                done = 1;
            } else {
                height = tex2D(height_map, hit.xy + reach * ((i + 1) / 8.0)).x;
                rise = (i + 1.1) / 8;
            }
        }
    }
    return float4(hit.xyz, light.z > 0 && height < hit.z + rise ? 1 : 0);
}
