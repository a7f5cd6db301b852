// FLIP, step by step as the paper's section 4; every kernel is separable and applied so.
#include "src/measure/flip.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace intaglio::measure {
namespace {

using Colour = std::array<double, 3>;
using Plane = std::vector<double>;

// The paper's constants: CSF by channel (table 1), exponents and the map of errors (4.1.3, 4.2).
constexpr double q_colour = 0.7, knee = 0.4, knee_error = 0.95, q_feature = 0.5;
constexpr double feature_width = 0.082;  // degrees

struct Image {
    int width, height;
    std::array<Plane, 3> planes;
    std::size_t size() const { return planes[0].size(); }
    Colour at(std::size_t i) const { return {planes[0][i], planes[1][i], planes[2][i]}; }
    void set(std::size_t i, const Colour& colour) {
        for (std::size_t c = 0; c < 3; ++c) planes[c][i] = colour[c];
    }
};

// Linear sRGB to XYZ (D65), as fractions in the paper's code.
constexpr double to_xyz[3][3] = {
    {10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
    {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
    {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};

// XYZ over that of white, so that white is (1, 1, 1).
Colour relative_xyz(const Colour& rgb) {
    Colour xyz{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double white = to_xyz[i][0] + to_xyz[i][1] + to_xyz[i][2];
        for (std::size_t j = 0; j < 3; ++j) xyz[i] += to_xyz[i][j] / white * rgb[j];
    }
    return xyz;
}

// By Cramer's rule.
Colour rgb_of_relative_xyz(const Colour& xyz) {
    double m[3][3];
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            m[i][j] = to_xyz[i][j] / (to_xyz[i][0] + to_xyz[i][1] + to_xyz[i][2]);
    const auto determinant = [](const double(&a)[3][3]) {
        return a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
               a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
               a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    };
    const double whole = determinant(m);
    Colour rgb{};
    for (std::size_t column = 0; column < 3; ++column) {
        double replaced[3][3];
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) replaced[i][j] = j == column ? xyz[i] : m[i][j];
        rgb[column] = determinant(replaced) / whole;
    }
    return rgb;
}

// The opponent space in which the eye's filters work.
Colour ycxcz(const Colour& xyz) {
    return {116 * xyz[1] - 16, 500 * (xyz[0] - xyz[1]), 200 * (xyz[1] - xyz[2])};
}
Colour xyz_of_ycxcz(const Colour& c) {
    const double y = (c[0] + 16) / 116;
    return {y + c[1] / 500, y, y - c[2] / 200};
}

// CIELAB with a and b shrunk in the dark (Hunt).
Colour hunt_lab(const Colour& rgb) {
    const auto root = [](double t) {
        constexpr double delta = 6.0 / 29;
        return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
    };
    const Colour xyz = relative_xyz(rgb);
    const double x = root(xyz[0]), y = root(xyz[1]), z = root(xyz[2]), lightness = 116 * y - 16;
    return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

double hyab(const Colour& a, const Colour& b) {
    return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

// Samples of a function at whole pixels from -radius to radius.
using Kernel = std::vector<double>;

template <typename Function>
Kernel kernel_of(int radius, Function function) {
    Kernel kernel;
    for (int x = -radius; x <= radius; ++x) kernel.push_back(function(x));
    return kernel;
}

double sum_of(const Kernel& kernel) {
    double sum = 0;
    for (double weight : kernel) sum += weight;
    return sum;
}

// Correlates with `along_x` across and `along_y` down; the edge pixels repeat outwards.
Plane filtered(const Plane& plane, int width, int height, const Kernel& along_x,
               const Kernel& along_y) {
    const int radius = static_cast<int>(along_x.size() / 2);
    Plane across(plane.size()), result(plane.size());
    const auto at = [width](int x, int y) { return static_cast<std::size_t>(y * width + x); };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int k = -radius; k <= radius; ++k)
                across[at(x, y)] += along_x[static_cast<std::size_t>(k + radius)] *
                                    plane[at(std::clamp(x + k, 0, width - 1), y)];
    for (int y = 0; y < height; ++y)
        for (int k = -radius; k <= radius; ++k) {
            const double weight = along_y[static_cast<std::size_t>(k + radius)];
            const int row = std::clamp(y + k, 0, height - 1);
            for (int x = 0; x < width; ++x) result[at(x, y)] += weight * across[at(x, row)];
        }
    return result;
}

// What the eye sees of one opponent channel: sums of Gaussians a sqrt(pi / b) exp(-pi^2 d^2 / b), d
// in degrees.
Plane seen(const Plane& plane, int width, int height, std::vector<std::pair<double, double>> terms,
           double pixels_per_degree) {
    constexpr double widest = 0.04;  // the greatest b of all channels, whose radius all take
    constexpr double pi = std::numbers::pi;
    const int radius =
        static_cast<int>(std::ceil(3 * std::sqrt(widest / (2 * pi * pi)) * pixels_per_degree));
    Plane sum(plane.size());
    double weight = 0;
    for (const auto& [a, b] : terms) {
        const Kernel kernel = kernel_of(radius, [&, b = b](int x) {
            const double degrees = x / pixels_per_degree;
            return std::exp(-pi * pi * degrees * degrees / b);
        });
        const double amount = a * std::sqrt(pi / b), total = sum_of(kernel);
        weight += amount * total * total;
        const Plane part = filtered(plane, width, height, kernel, kernel);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += amount * part[i];
    }
    for (double& value : sum) value /= weight;
    return sum;
}

// The picture as an eye that resolves so much sees it, in linear light again, as Hunt-adjusted Lab.
Image perceived(const Image& opponent, double pixels_per_degree) {
    Image image = opponent;
    const auto see = [&](std::size_t c, std::vector<std::pair<double, double>> terms) {
        image.planes[c] = seen(opponent.planes[c], image.width, image.height, std::move(terms),
                               pixels_per_degree);
    };
    see(0, {{1, 0.0047}});
    see(1, {{1, 0.0053}});
    see(2, {{34.1, 0.04}, {13.5, 0.025}});
    for (std::size_t i = 0; i < image.size(); ++i) {
        Colour rgb = rgb_of_relative_xyz(xyz_of_ycxcz(image.at(i)));
        for (double& c : rgb) c = std::clamp(c, 0.0, 1.0);
        image.set(i, hunt_lab(rgb));
    }
    return image;
}

// Positive weights and negative ones each sum to one.
void balance(Kernel& kernel) {
    double positive = 0, negative = 0;
    for (double weight : kernel) (weight > 0 ? positive : negative) += weight;
    for (double& weight : kernel) weight /= weight > 0 ? positive : -negative;
}

// How strong the edges (or points) of the picture are at each pixel.
Plane features(const Image& opponent, bool points, double pixels_per_degree) {
    const double sigma = 0.5 * feature_width * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3 * sigma));
    Plane light = opponent.planes[0];
    for (double& value : light) value = (value + 16) / 116;
    Kernel smooth =
        kernel_of(radius, [&](int x) { return std::exp(-x * x / (2 * sigma * sigma)); });
    Kernel differ = kernel_of(radius, [&](int x) {
        const double bell = std::exp(-x * x / (2 * sigma * sigma));
        return points ? (x * x / (sigma * sigma) - 1) * bell : -x * bell;
    });
    const double total = sum_of(smooth);
    for (double& weight : smooth) weight /= total;
    balance(differ);
    const Plane x = filtered(light, opponent.width, opponent.height, differ, smooth);
    const Plane y = filtered(light, opponent.width, opponent.height, smooth, differ);
    Plane strength(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) strength[i] = std::hypot(x[i], y[i]);
    return strength;
}

Colour shown(const std::array<float, 4>& pixel) {
    if (!std::all_of(pixel.begin(), pixel.end(), [](float c) { return std::isfinite(c); }))
        return {1, 0, 1};
    Colour colour{};
    for (std::size_t c = 0; c < 3; ++c)
        colour[c] = std::clamp(static_cast<double>(pixel[c]), 0.0, 1.0);
    return colour;
}

Image opponent_of(const vulkan::Picture& picture) {
    Image image{picture.width, picture.height, {}};
    for (Plane& plane : image.planes) plane.resize(picture.pixels.size());
    for (std::size_t i = 0; i < image.size(); ++i)
        image.set(i, ycxcz(relative_xyz(shown(picture.pixels[i]))));
    return image;
}

// Distances to [0, 1]: most of the range for those below the knee.
double mapped(double distance, double largest) {
    const double power = std::pow(distance, q_colour), at_knee = knee * largest;
    if (power < at_knee) return knee_error / at_knee * power;
    return knee_error + (power - at_knee) / (largest - at_knee) * (1 - knee_error);
}

double srgb_curve(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace

std::vector<float> flip_map(const vulkan::Picture& reference, const vulkan::Picture& test,
                            double pixels_per_degree) {
    const Image a = opponent_of(reference), b = opponent_of(test);
    const Image seen_a = perceived(a, pixels_per_degree), seen_b = perceived(b, pixels_per_degree);
    const double largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), q_colour);
    std::vector<float> map(a.size());
    std::array<Plane, 2> change;
    for (std::size_t i = 0; i < 2; ++i) {
        change[i] = features(a, i == 1, pixels_per_degree);
        const Plane other = features(b, i == 1, pixels_per_degree);
        for (std::size_t j = 0; j < other.size(); ++j)
            change[i][j] = std::abs(change[i][j] - other[j]);
    }
    for (std::size_t i = 0; i < map.size(); ++i) {
        const double colour = mapped(hyab(seen_a.at(i), seen_b.at(i)), largest);
        const double feature = std::pow(
            std::min(1.0, std::max(change[0][i], change[1][i]) / std::numbers::sqrt2), q_feature);
        map[i] = static_cast<float>(std::clamp(std::pow(colour, 1 - feature), 0.0, 1.0));
    }
    return map;
}

PictureError compare_pictures(const vulkan::Picture& reference, const vulkan::Picture& test) {
    PictureError error;
    std::vector<float> map = flip_map(reference, test);
    const auto worst = std::max_element(map.begin(), map.end());
    error.flip_max = static_cast<double>(*worst);
    error.flip_worst_x = static_cast<int>(worst - map.begin()) % reference.width;
    error.flip_worst_y = static_cast<int>(worst - map.begin()) / reference.width;
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < map.size(); ++i) {
        sum += static_cast<double>(map[i]);
        const Colour a = shown(reference.pixels[i]), b = shown(test.pixels[i]);
        for (std::size_t c = 0; c < 3; ++c)
            squares += std::pow(srgb_curve(a[c]) - srgb_curve(b[c]), 2);
        error.invalid += !std::all_of(test.pixels[i].begin(), test.pixels[i].end(),
                                      [](float c) { return std::isfinite(c); });
    }
    const double count = static_cast<double>(map.size());
    error.flip_mean = sum / count;
    std::sort(map.begin(), map.end());
    error.flip_p95 =
        static_cast<double>(map[static_cast<std::size_t>(std::llround(0.95 * (count - 1)))]);
    error.psnr = squares > 0 ? -10 * std::log10(squares / (3 * count))
                             : std::numeric_limits<double>::infinity();
    return error;
}

}  // namespace intaglio::measure
