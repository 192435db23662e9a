#include "evaluation/accuracy/box.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace ttf::evaluation::accuracy {
namespace {

using fusion::metrics::Point;

constexpr std::array kFaces{Face::kRear, Face::kFront, Face::kRight, Face::kLeft};

// The outward normal in the box' own axes, and the face's distance from the centre.
Point normal_of(Face face) {
  switch (face) {
    case Face::kRear: return {-1.0, 0.0};
    case Face::kFront: return {1.0, 0.0};
    case Face::kRight: return {0.0, -1.0};
    case Face::kLeft: break;
  }
  return {0.0, 1.0};
}
double reach_of(const Box& box, Face face) {
  return 0.5 * (face == Face::kRear || face == Face::kFront ? box.length : box.width);
}

// The origin in the box' own axes.
Point origin_in(const Box& box) {
  const double c = std::cos(box.heading), s = std::sin(box.heading);
  return {-(c * box.x + s * box.y), s * box.x - c * box.y};
}

double dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y; }

// Turns from a box' own axes.
Point turned(const Point& own, double heading) {
  const double c = std::cos(heading), s = std::sin(heading);
  return {c * own.x - s * own.y, s * own.x + c * own.y};
}

double half_turn(double angle) { return std::remainder(angle, 2.0 * std::numbers::pi); }

}  // namespace

Face visible_face(const Box& box) {
  const Point origin = origin_in(box);
  const auto turned_to_it = [&](Face face) { return dot(normal_of(face), origin) > reach_of(box, face); };
  const bool outside = std::any_of(kFaces.begin(), kFaces.end(), turned_to_it);
  Face nearest = Face::kRear;
  double least = std::numeric_limits<double>::infinity();
  for (const Face face : kFaces) {
    if (outside && !turned_to_it(face)) continue;
    const Point normal = normal_of(face);
    const double reach = reach_of(box, face);
    if (const double distance = std::hypot(origin.x - reach * normal.x, origin.y - reach * normal.y);
        distance < least) {
      least = distance;
      nearest = face;
    }
  }
  return nearest;
}

Point middle_of(const Box& box, Face face) {
  const Point normal = turned(normal_of(face), box.heading);
  const double reach = reach_of(box, face);
  return {box.x + reach * normal.x, box.y + reach * normal.y};
}

// On the line of sight, the box begins at the share `inside` of the way from its centre to the origin.
double gap_m(const Box& box) {
  const Point origin = origin_in(box);
  const auto share = [](double half, double way) {
    return way > 0.0 ? half / way : std::numeric_limits<double>::infinity();
  };
  const double inside =
      std::min(share(0.5 * box.length, std::abs(origin.x)), share(0.5 * box.width, std::abs(origin.y)));
  return inside < 1.0 ? (1.0 - inside) * std::hypot(box.x, box.y) : 0.0;
}

BoxError error_of(const Box& estimate, const Box& truth) {
  const Face seen = visible_face(truth);
  const Point towards = turned(normal_of(seen), truth.heading - estimate.heading);
  Face own = Face::kRear;
  for (const Face face : kFaces)
    if (dot(normal_of(face), towards) > dot(normal_of(own), towards)) own = face;
  return {distance_m(middle_of(estimate, own), middle_of(truth, seen)), gap_m(estimate) - gap_m(truth),
          half_turn(estimate.heading - truth.heading), estimate.length - truth.length, estimate.width - truth.width};
}

}  // namespace ttf::evaluation::accuracy
