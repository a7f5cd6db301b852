// One list of words for all languages, so that a name does not change from target to target.
#include "generator/target/clike/names.h"

#include <cctype>
#include <unordered_set>

#include <fmt/format.h>

namespace intaglio::clike {
namespace {

// Keywords and reserved words of GLSL 4.60, ESSL 3.00 and HLSL (shader models 2 to 6), the types
// and functions that the emitted text itself uses, and the words that C++ based Metal would refuse.
// Types with digits: see is_reserved.
constexpr std::string_view reserved_words =
    " abs active all alignas alignof any asfloat asint asm asm_fragment asuint atan atomic_uint "
    "attribute auto bit "
    "blendstate bool break buffer case cast catch cbuffer ceil centroid char clamp class clip "
    "coherent column_major "
    "common compile compileshader computeshader const constant const_cast constexpr continue cos "
    "cosh cross dFdx dFdy "
    "ddx ddy default degrees delete depthstencilstate depthstencilview device determinant dfdx "
    "dfdy discard distance "
    "do domainshader dot double dword dynamic_cast else enum exp exp2 explicit export extern "
    "external "
    "faceforward false filter fixed flat float floor fma fmod for fract frac friend frexp fragment "
    "fxgroup geometryshader goto groupshared half highp hullshader if "
    "imageBuffer in inline inout input inputpatch instance int interface intrinsic invariant "
    "inverse inversesqrt isinf isnan kernel layout ldexp length lerp line lineadj linear "
    "linestream lit log log10 "
    "log2 long lowp main mat matrix max mediump metal min mix mod modf mul mutable namespace new "
    "nointerpolation "
    "noise noperspective normalize not null NULL operator or out output outputpatch packed "
    "packoffset partition pass "
    "patch pixelfragment pixelshader point pointstream pow precise precision private protected "
    "public radians rcp "
    "readonly reflect refract register reinterpret_cast resource restrict return round row_major "
    "rsqrt sample "
    "sampler samplerstate saturate shared short sign signed sin sincos sinh sizeof smooth "
    "smoothstep snorm "
    "sqrt stateblock stateblock_state static static_cast std step string struct subroutine superp "
    "switch tan tanh "
    "tbuffer technique technique10 technique11 template tex1D tex2D tex2Dbias tex2Dgrad tex2Dlod "
    "tex2Dproj tex3D "
    "tex3Dgrad tex3Dlod texCUBE texelFetch texture texture1D texture2D texture3D textureCube "
    "textureGrad textureLod "
    "textureSize this thread threadgroup throw transpose triangle triangleadj trianglestream true "
    "trunc try typedef "
    "typeid typename uint uniform union unorm unsigned using varying vec vector vertex "
    "vertexfragment vertexshader "
    "virtual void volatile while writeonly xor and bitand bitor compl and_eq or_eq xor_eq not_eq "
    "using "
    // Names that the shells of the targets use.
    "Attributes Interpolants Targets VertexUniforms PixelUniforms pixel result vertex_main "
    "pixel_main ";

constexpr std::string_view typed_prefixes[] = {
    "vec",        "bvec",       "ivec",     "uvec",     "dvec",      "mat",    "dmat",
    "float",      "half",       "int",      "uint",     "bool",      "double", "dword",
    "min16float", "min10float", "min16int", "min12int", "min16uint", "fvec",   "hvec",
    "short",      "ushort",     "char",     "uchar",    "long",      "ulong"};
constexpr std::string_view sampler_prefixes[] = {
    "sampler",   "isampler", "usampler", "image",    "iimage",   "uimage",  "Texture",
    "RWTexture", "Buffer",   "Sampler",  "texture1", "texture2", "texture3"};

const std::unordered_set<std::string_view>& reserved_set() {
    static const std::unordered_set<std::string_view> words = [] {
        std::unordered_set<std::string_view> set;
        std::string_view rest = reserved_words;
        for (std::size_t end; (end = rest.find(' ')) != std::string_view::npos;
             rest.remove_prefix(end + 1))
            if (end > 0) set.insert(rest.substr(0, end));
        return set;
    }();
    return words;
}

bool is_shape_suffix(std::string_view text) {
    for (char c : text)
        if (!std::isdigit(static_cast<unsigned char>(c)) && c != 'x') return false;
    return true;
}

}  // namespace

bool is_reserved(std::string_view name) {
    if (reserved_set().contains(name)) return true;
    for (std::string_view prefix : typed_prefixes)
        if (name.starts_with(prefix) && is_shape_suffix(name.substr(prefix.size()))) return true;
    // sampler2DShadow, Texture2D, imageCube: a capital or a digit after the prefix marks a type.
    for (std::string_view prefix : sampler_prefixes) {
        if (!name.starts_with(prefix)) continue;
        const std::string_view rest = name.substr(prefix.size());
        if (rest.empty() || std::isdigit(static_cast<unsigned char>(rest[0])) ||
            std::isupper(static_cast<unsigned char>(rest[0])))
            return true;
    }
    return false;
}

std::string legal_name(std::string_view name) {
    std::string legal;
    for (char c : name) {
        const bool word = std::isalnum(static_cast<unsigned char>(c)) != 0;
        if (word)
            legal += c;
        else if (!legal.empty() && legal.back() != '_')
            legal += '_';
    }
    while (!legal.empty() && legal.back() == '_') legal.pop_back();
    if (legal.empty()) return legal;
    if (std::isdigit(static_cast<unsigned char>(legal[0])) || legal.starts_with("gl_") ||
        legal.starts_with("webgl_"))
        legal.insert(0, "n_");
    if (is_reserved(legal)) legal += "_value";
    return legal;
}

bool NameScope::visible(const std::string& name) const {
    for (const auto& level : levels_)
        if (level.contains(name)) return true;
    return false;
}

std::string NameScope::declare(std::string_view wanted, std::string_view fallback) {
    std::string base = legal_name(wanted);
    if (base.empty()) base = legal_name(fallback);
    std::string name = base;
    for (int number = 2; visible(name); ++number) name = fmt::format("{}_{}", base, number);
    levels_.back().insert(name);
    return name;
}

std::string NameScope::declare_everywhere(std::string_view wanted) {
    std::string name = declare(wanted);
    levels_.front().insert(name);
    return name;
}

}  // namespace intaglio::clike
