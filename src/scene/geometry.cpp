// In the surface's own frame its polygon is a rectangle in z = 0, so that a point's elevation above
// it is atan2(z, r) with r the distance along the plane.  Over a straight piece of the path z is
// linear, and r to a corner the root of a quadratic: where z / r and z^2 + r^2 turn has a closed
// form.
#include "src/scene/geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace intaglio::scene {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double infinity = std::numeric_limits<double>::infinity();

Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point operator*(const Point& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Point& a) { return std::sqrt(dot(a, a)); }
Point cross(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Point between(const Point& a, const Point& b, double t) { return a + (b - a) * t; }

// A direction in the place's frame.
Point to_frame(const Point& direction, const Place& place) {
    return {dot(direction, place.tangent), dot(direction, place.bitangent),
            dot(direction, place.normal)};
}

struct Rectangle {
    Span u, v;
    double r_least(double x, double y) const {
        return std::hypot(std::max({u.least - x, x - u.most, 0.0}),
                          std::max({v.least - y, y - v.most, 0.0}));
    }
    double r_most(double x, double y) const {
        return std::hypot(std::max(x - u.least, u.most - x), std::max(y - v.least, v.most - y));
    }
};

// Arcs on the circle; what they leave free is kept as the greatest gap.
class Arcs {
  public:
    // Degrees; any winding.
    void add(double least, double width) {
        if (width >= 360) full_ = true;
        least -= 360 * std::floor(least / 360);
        arcs_.push_back({least, least + width});
    }
    bool empty() const { return arcs_.empty() && !full_; }
    // The shortest arc that holds all; within [-360, 360].
    Span hull() {
        if (full_ || arcs_.empty()) return {0, 360};
        std::sort(arcs_.begin(), arcs_.end(),
                  [](const Span& a, const Span& b) { return a.least < b.least; });
        double reached = 0;
        for (const Span& arc : arcs_) reached = std::max(reached, arc.most);
        reached -= 360;  // how far the last turn comes into this one
        double widest = 0, start = 0, end = 360;
        for (const Span& arc : arcs_) {
            if (arc.least - reached > widest) {
                widest = arc.least - reached;
                start = arc.least;
                end = reached + 360;
            }
            reached = std::max(reached, arc.most);
        }
        if (widest <= 0) return {0, 360};
        if (end > 360) return {start - 360, end - 360};
        return {start, end};
    }

  private:
    std::vector<Span> arcs_;
    bool full_ = false;
};

// Rounding of the steps above is far below 1e-9 degrees; ranges are widened to a millionth, which
// also makes them the same whatever the C library's last bit.
Span widened(Span span) {
    constexpr double steps = 1e6;
    if (span.most - span.least < 1e-9) {
        const double middle = std::round((span.least + span.most) / 2 * 1e9) / 1e9;
        return {middle, middle};
    }
    return {std::floor(span.least * steps - 1e-3) / steps,
            std::ceil(span.most * steps + 1e-3) / steps};
}

Span clamped(Span span, double least, double most) {
    return {std::clamp(span.least, least, most), std::clamp(span.most, least, most)};
}

class Collected {
  public:
    void add(const Ranges& ranges) {
        join(all_.elevation, ranges.elevation);
        join(all_.distance, ranges.distance);
        azimuths_.add(ranges.azimuth.least, ranges.azimuth.most - ranges.azimuth.least);
    }
    bool empty() const { return azimuths_.empty(); }
    Ranges ranges() {
        const Span azimuth = widened(azimuths_.hull());
        return {clamped(widened(all_.elevation), -90, 90),
                azimuth.most - azimuth.least >= 360 ? Span{0, 360} : azimuth,
                clamped(widened(all_.distance), 0, infinity)};
    }

  private:
    static void join(Span& into, const Span& other) {
        into.least = std::min(into.least, other.least);
        into.most = std::max(into.most, other.most);
    }
    Ranges all_{{infinity, -infinity}, {}, {infinity, -infinity}};
    Arcs azimuths_;
};

// The turning points of elevation and distance along a + (b - a) t, and the ends.
std::vector<double> turns_of(const Point& a, const Point& b, const Rectangle& rectangle) {
    std::vector<double> turns{0, 1};
    const Point d = b - a;
    turns.push_back(-a[2] / d[2]);
    for (int axis = 0; axis < 2; ++axis) {
        const Span& side = axis == 0 ? rectangle.u : rectangle.v;
        const auto i = static_cast<std::size_t>(axis);
        for (double line : {side.least, side.most}) {
            const double offset = a[i] - line;
            turns.push_back(-offset / d[i]);  // crosses the edge's line
            turns.push_back(-(a[2] * d[2] + offset * d[i]) / (d[2] * d[2] + d[i] * d[i]));
        }
    }
    for (double u : {rectangle.u.least, rectangle.u.most}) {
        for (double v : {rectangle.v.least, rectangle.v.most}) {
            const double x = a[0] - u, y = a[1] - v;
            // r^2 = A t^2 + B t + C
            const double A = d[0] * d[0] + d[1] * d[1], B = 2 * (x * d[0] + y * d[1]);
            const double C = x * x + y * y;
            turns.push_back((a[2] * B - 2 * d[2] * C) / (d[2] * B - 2 * A * a[2]));
            turns.push_back(-(2 * a[2] * d[2] + B) / (2 * d[2] * d[2] + 2 * A));
        }
    }
    // Without a turn the divisions above give NaN or infinity.
    std::erase_if(turns, [](double t) { return !(t >= 0 && t <= 1); });
    return turns;
}

// The directions of all differences of two convex sets, given their corners: a fan, or all around.
Span azimuths_of(const Point& a, const Point& b, const Rectangle& rectangle) {
    std::vector<std::array<double, 2>> corners;
    for (const Point& eye : {a, b})
        for (double u : {rectangle.u.least, rectangle.u.most})
            for (double v : {rectangle.v.least, rectangle.v.most})
                corners.push_back({eye[0] - u, eye[1] - v});
    std::vector<double> angles;
    for (const auto& corner : corners) {
        if (corner[0] == 0 && corner[1] == 0) return {0, 360};
        angles.push_back(std::atan2(corner[1], corner[0]) / degree);
    }
    std::sort(angles.begin(), angles.end());
    double widest = angles.front() + 360 - angles.back();
    Span fan{angles.front(), angles.back()};
    for (std::size_t i = 1; i < angles.size(); ++i) {
        if (angles[i] - angles[i - 1] <= widest) continue;
        widest = angles[i] - angles[i - 1];
        fan = {angles[i], angles[i - 1] + 360};
    }
    // Seen from outside of their hull the corners lie within a half circle; a hull that has the
    // origin on its edge is counted as around it.
    return widest > 180 + 1e-9 ? fan : Span{0, 360};
}

// `a` to `b` in the place's frame.
Ranges ranges_of_piece(const Point& a, const Point& b, const Rectangle& rectangle) {
    Ranges ranges{{infinity, -infinity}, azimuths_of(a, b, rectangle), {infinity, -infinity}};
    for (double t : turns_of(a, b, rectangle)) {
        const Point eye = between(a, b, t);
        for (double r : {rectangle.r_least(eye[0], eye[1]), rectangle.r_most(eye[0], eye[1])}) {
            const double elevation = std::atan2(eye[2], r) / degree;
            const double distance = std::hypot(eye[2], r);
            ranges.elevation.least = std::min(ranges.elevation.least, elevation);
            ranges.elevation.most = std::max(ranges.elevation.most, elevation);
            ranges.distance.least = std::min(ranges.distance.least, distance);
            ranges.distance.most = std::max(ranges.distance.most, distance);
        }
    }
    return ranges;
}

Rectangle rectangle_of(const Place& place) {
    return {{-place.width / 2, place.width / 2}, {-place.height / 2, place.height / 2}};
}

// A straight piece of the path with what is looked at along it, in the place's frame.
struct Piece {
    Point from, to, look_from, look_to;
    Piece part(double begin, double end) const {
        return {between(from, to, begin), between(from, to, end),
                between(look_from, look_to, begin), between(look_from, look_to, end)};
    }
};

// How far a vector's direction can turn when it moves by `by`; a half circle where it may vanish.
double most_turn(double vector_length, double by) {
    return by < vector_length ? std::asin(by / vector_length) : std::numbers::pi;
}

// False only where no point of the cell is inside the picture's corners from any point of the
// piece.
bool may_see(const Piece& piece, const Rectangle& cell, double half_angle) {
    const Point middle{(cell.u.least + cell.u.most) / 2, (cell.v.least + cell.v.most) / 2, 0};
    const Point eye = between(piece.from, piece.to, 0.5);
    const Point look = between(piece.look_from, piece.look_to, 0.5) - eye;
    const Point ray = middle - eye;
    const double half_diagonal =
        std::hypot(cell.u.most - cell.u.least, cell.v.most - cell.v.least) / 2;
    const double turn_of_ray =
        most_turn(length(ray), length(piece.to - piece.from) / 2 + half_diagonal);
    const double turn_of_look = most_turn(
        length(look), length((piece.look_to - piece.to) - (piece.look_from - piece.from)) / 2);
    const double angle = std::atan2(length(cross(look, ray)), dot(look, ray));
    return !(angle - turn_of_ray - turn_of_look > half_angle + 1e-9);
}

// Adds what is seen of a rectangle from a piece.
void add_piece(const Piece& piece, const Rectangle& rectangle, Collected& into) {
    // Behind the polygon nothing is seen.
    const double a = piece.from[2], b = piece.to[2];
    if (a <= 0 && b <= 0) return;
    const double begin = a < 0 ? a / (a - b) : 0, end = b < 0 ? a / (a - b) : 1;
    Piece front = piece.part(begin, end);
    for (Point* point : {&front.from, &front.to}) (*point)[2] = std::max((*point)[2], 0.0);
    into.add(ranges_of_piece(front.from, front.to, rectangle));
}

// In how many parts a piece and a side of the place are divided to ask what is in the picture.
constexpr int parts = 16;

void add_picture(const Piece& piece, const Rectangle& rectangle, double half_angle,
                 Collected& into) {
    const auto share = [](Span span, int i) {
        const double step = (span.most - span.least) / parts;
        return Span{span.least + step * i,
                    i + 1 == parts ? span.most : span.least + step * (i + 1)};
    };
    for (int t = 0; t < parts; ++t) {
        const Piece part = piece.part(t / double{parts}, (t + 1) / double{parts});
        for (int i = 0; i < parts; ++i)
            for (int j = 0; j < parts; ++j)
                if (const Rectangle cell{share(rectangle.u, i), share(rectangle.v, j)};
                    may_see(part, cell, half_angle))
                    add_piece(part, cell, into);
    }
}

}  // namespace

Point direction_of(double elevation, double azimuth) {
    const double e = elevation * degree, a = azimuth * degree;
    return {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)};
}

std::optional<Place> place_of(Point position, Point normal, Point tangent, bool mirrored,
                              double width, double height) {
    const double normal_length = length(normal), tangent_length = length(tangent);
    if (!(normal_length > 0) || !(tangent_length > 0)) return std::nullopt;
    normal = normal * (1 / normal_length);
    tangent = tangent * (1 / tangent_length);
    tangent = tangent - normal * dot(normal, tangent);
    const double left = length(tangent);
    if (left < 1e-6) return std::nullopt;
    tangent = tangent * (1 / left);
    return Place{position, tangent, cross(normal, tangent) * (mirrored ? -1.0 : 1.0),
                 normal,   width,   height};
}

std::optional<Ranges> ranges_of_camera(const Camera& camera, const Place& place) {
    const double half_height = std::tan(camera.field_of_view / 2 * degree);
    const double half_angle = std::atan(half_height * std::hypot(1, camera.aspect));
    const auto in_frame = [&](const Point& point) {
        return to_frame(point - place.position, place);
    };
    const Rectangle rectangle = rectangle_of(place);
    const bool looks = !camera.targets.empty();
    Collected collected;
    for (std::size_t i = 0; i < camera.path.size(); ++i) {
        const std::size_t next = std::min(i + 1, camera.path.size() - 1);
        if (i == next && i > 0) break;
        Piece piece{in_frame(camera.path[i]), in_frame(camera.path[next]), {}, {}};
        if (!looks) {
            add_piece(piece, rectangle, collected);
            continue;
        }
        piece.look_from = in_frame(camera.targets[i]);
        piece.look_to = in_frame(camera.targets[next]);
        add_picture(piece, rectangle, half_angle, collected);
    }
    if (collected.empty()) return std::nullopt;
    Ranges ranges = collected.ranges();
    if (ranges.elevation.most < camera.least_elevation) return std::nullopt;
    ranges.elevation.least = std::max(ranges.elevation.least, camera.least_elevation);
    ranges.distance = clamped(ranges.distance, camera.near, infinity);
    return ranges;
}

Ranges ranges_of_lamp(const Point& lamp, const Place& place) {
    const Point point = to_frame(lamp - place.position, place);
    Collected collected;
    collected.add(ranges_of_piece(point, point, rectangle_of(place)));
    return collected.ranges();
}

namespace {

// The greatest and least of dot(normal, direction) over the range: at corners, on an edge of equal
// elevation where the azimuths agree or oppose, on one of equal azimuth where the derivative is
// zero, and inside at the normal and its opposite.
Span elevations_of_sun(Span elevation, Span azimuth, const Point& normal) {
    const double turned = std::atan2(normal[1], normal[0]) / degree;
    const auto inside = [](Span span, double angle) {
        angle -= 360 * std::floor((angle - span.least) / 360);
        return angle <= span.most ? std::optional<double>(angle) : std::nullopt;
    };
    std::vector<double> azimuths{azimuth.least, azimuth.most};
    for (double candidate : {turned, turned + 180})
        if (const auto found = inside(azimuth, candidate)) azimuths.push_back(*found);
    Span angles{90, -90};
    for (double a : azimuths) {
        std::vector<double> elevations{elevation.least, elevation.most};
        // n . d = (nx cos a + ny sin a) cos e + nz sin e turns at atan2(nz, ...).
        const double flat = normal[0] * std::cos(a * degree) + normal[1] * std::sin(a * degree);
        for (double e :
             {std::atan2(normal[2], flat) / degree, std::atan2(-normal[2], -flat) / degree})
            if (e >= elevation.least && e <= elevation.most) elevations.push_back(e);
        for (double e : elevations) {
            const Point direction = direction_of(e, a);
            const double angle =
                std::atan2(dot(normal, direction), length(cross(normal, direction))) / degree;
            angles.least = std::min(angles.least, angle);
            angles.most = std::max(angles.most, angle);
        }
    }
    return angles;
}

// Adds the azimuths of all directions within `radius` (degrees) of one.
void add_cap(const Point& direction, double radius, Arcs& arcs) {
    const double flat = std::hypot(direction[0], direction[1]);
    const double middle = std::atan2(direction[1], direction[0]) / degree;
    const double sine = std::sin(radius * degree);
    if (radius == 0 && flat > 0) {
        arcs.add(middle, 0);
    } else if (sine >= flat) {
        arcs.add(0, 360);
    } else {
        const double half = std::asin(sine / flat) / degree;
        arcs.add(middle - half, 2 * half);
    }
}

}  // namespace

// Azimuths have no extreme inside a range that holds neither the normal nor its opposite (where
// they have all values), so the range's four edges are walked, in steps that a cap of directions
// holds.
Ranges ranges_of_sun(Span elevation, Span azimuth, const Place& place) {
    const Place upright;
    if (place.tangent == upright.tangent && place.bitangent == upright.bitangent)
        return {elevation, azimuth, {0, 0}};
    constexpr double step = 0.25;
    Arcs arcs;
    const auto walk = [&](Span along, bool turns, double fixed) {
        const double width = along.most - along.least;
        const int count = std::max(1, static_cast<int>(std::ceil(width / step)));
        for (int i = 0; i < count; ++i) {
            const double at = along.least + width * (i + 0.5) / count;
            const Point direction = turns ? direction_of(fixed, at) : direction_of(at, fixed);
            add_cap(to_frame(direction, place), width / count / 2, arcs);
        }
    };
    for (double e : {elevation.least, elevation.most}) walk(azimuth, true, e);
    for (double a : {azimuth.least, azimuth.most}) walk(elevation, false, a);
    const Span elevations = elevations_of_sun(elevation, azimuth, place.normal);
    const bool around = elevations.most > 90 - 1e-6 || elevations.least < -90 + 1e-6;
    const Span azimuths = around ? Span{0, 360} : arcs.hull();
    Collected collected;
    collected.add({elevations, azimuths, {0, 0}});
    return collected.ranges();
}

}  // namespace intaglio::scene
