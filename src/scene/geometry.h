// From a camera's path and a light's range in the world to ranges over one surface: elevation,
// azimuth and distance.  Extremes of elevation and distance are closed forms; azimuths, and what a
// camera with targets sees, are bounded cell by cell.  Every range holds whatever truly occurs.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "src/scene/span.h"

namespace intaglio::scene {

using Point = std::array<double, 3>;

// A rectangle in the world.  The three axes are unit and orthogonal.
struct Place {
    Point position{0, 0, 0};  // its middle
    Point tangent{1, 0, 0}, bitangent{0, 1, 0}, normal{0, 0, 1};
    double width = 1, height = 1;  // along tangent and bitangent
};
// `tangent` is made orthogonal to the normal; nothing where one of them is zero or they are
// parallel.
std::optional<Place> place_of(Point position, Point normal, Point tangent, bool mirrored,
                              double width, double height);

struct Camera {
    std::vector<Point> path;     // at least one point; straight between them
    std::vector<Point> targets;  // empty, or as many as the path: what is in the picture's middle
    double field_of_view = 60;   // vertical, degrees
    double aspect = 16.0 / 9;
    int pixels = 1080;
    double near = 0.1;
    double least_elevation = 1;
};

struct Ranges {
    Span elevation;  // degrees
    Span azimuth;    // degrees; most - least <= 360
    Span distance;   // world units
};

// All directions from points of the place to the camera, where it is in front and at least
// camera.least_elevation above.  With targets, points outside the picture's corners do not count,
// as far as dividing path and place into cells can tell.  Nothing where the camera sees no point.
std::optional<Ranges> ranges_of_camera(const Camera& camera, const Place& place);

// The directions from points of the place to a light at a point.
Ranges ranges_of_lamp(const Point& lamp, const Place& place);
// The directions of a light at infinity, in world space: elevation above the xy plane in [-90, 90],
// azimuth from +x towards +y.  Distance is 0.
Ranges ranges_of_sun(Span elevation, Span azimuth, const Place& place);

// Unit.
Point direction_of(double elevation, double azimuth);

}  // namespace intaglio::scene
