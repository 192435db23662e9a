#include "nodes/laser/orientation_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "fusion/batch/lanes.h"

namespace ttf::nodes::laser {
namespace {

using ttf::fusion::batch::kLanes;
using ttf::fusion::batch::Lanes;
using ttf::fusion::batch::Mask;
using ttf::fusion::batch::select;

constexpr double kCoarseStep = std::numbers::pi / 90.0;
constexpr int kCoarseAngles = 45;
constexpr int kFineReach = 9, kFineAngles = 2 * kFineReach + 1;  // on either side, up to the next coarse angle

// Candidate angles, and the directions of their rectangles' axes, a quarter turn apart.
struct Candidates {
  Lanes angle, ax, ay, bx, by;
};
template <int kAngles> using Groups = std::array<Candidates, (kAngles + kLanes - 1) / kLanes>;

// Spare lanes repeat the last angle, which cannot score higher than itself.
template <int kAngles, class AngleOf> Groups<kAngles> candidates(AngleOf angle_of) {
  Groups<kAngles> groups{};
  int i = 0;
  for (Candidates& group : groups)
    for (int lane = 0; lane < kLanes; ++lane, ++i) {
      const double angle = angle_of(std::min(i, kAngles - 1)), quarter_on = angle + 0.5 * std::numbers::pi;
      group.angle[lane] = angle;
      group.ax[lane] = std::cos(angle);
      group.ay[lane] = std::sin(angle);
      group.bx[lane] = std::cos(quarter_on);
      group.by[lane] = std::sin(quarter_on);
    }
  return groups;
}

struct Grid {
  Groups<kCoarseAngles> coarse;
  std::array<Groups<kFineAngles>, kCoarseAngles> fine;  // around each coarse angle
  Grid() : coarse(candidates<kCoarseAngles>([](int i) { return i * kCoarseStep; })) {
    int i = 0;
    for (Groups<kFineAngles>& around : fine) {
      const double centre = i++ * kCoarseStep;
      around = candidates<kFineAngles>([&](int k) { return centre + (k - kFineReach) * kCoarseStep / kFineReach; });
    }
  }
};

const Grid& grid() {
  static const Grid kGrid;
  return kGrid;
}

// One axis of four candidates, pointing away from the sensor, and the position of its near face.
struct NearFaces {
  Lanes x, y, near;
  Mask visible;
};

NearFaces near_faces(const Lanes& x, const Lanes& y, const Lanes& low, const Lanes& high) {
  const Mask away = low + high >= 0.0;
  return {select(away, x, -x), select(away, y, -y), select(away, low, -high), (low > 0.0) | (high < 0.0)};
}

Lanes scores(const Candidates& c, std::span<const PlanePoint> points, double closest) {
  const Lanes infinity = Lanes{} + std::numeric_limits<double>::infinity();
  Lanes a_low = infinity, a_high = -infinity, b_low = infinity, b_high = -infinity;
  for (const PlanePoint& point : points) {
    const Lanes a = c.ax * point.x + c.ay * point.y, b = c.bx * point.x + c.by * point.y;
    a_low = select(a < a_low, a, a_low);
    a_high = select(a > a_high, a, a_high);
    b_low = select(b < b_low, b, b_low);
    b_high = select(b > b_high, b, b_high);
  }
  NearFaces a = near_faces(c.ax, c.ay, a_low, a_high), b = near_faces(c.bx, c.by, b_low, b_high);
  // A hidden face is never the nearer one. If both are hidden, the second counts.
  a.near = select(a.visible, a.near, -infinity);
  b.near = select(b.visible | ~a.visible, b.near, -infinity);
  const Lanes floor = Lanes{} + closest;
  Lanes sum{};
  for (const PlanePoint& point : points) {
    // Never negative: all returns lie beyond the near face.
    const Lanes da = a.x * point.x + a.y * point.y - a.near, db = b.x * point.x + b.y * point.y - b.near;
    const Lanes distance = select(db < da, db, da);
    sum += 1.0 / select(distance < floor, floor, distance);
  }
  return sum;
}

struct Best {
  double angle = 0.0, score = -1.0;
  int index = 0;
};

void search(std::span<const Candidates> groups, std::span<const PlanePoint> points, double closest, Best& best) {
  int index = 0;
  for (const Candidates& group : groups) {
    const Lanes score = scores(group, points, closest);
    for (int lane = 0; lane < kLanes; ++lane, ++index)
      if (score[lane] > best.score) best = {group.angle[lane], score[lane], index};
  }
}

}  // namespace

double search_orientation(std::span<const PlanePoint> points, double closest) {
  Best best;
  search(grid().coarse, points, closest, best);
  search(grid().fine[static_cast<std::size_t>(best.index)], points, closest, best);
  return best.angle;
}

void prepare_orientation_search() { grid(); }

}  // namespace ttf::nodes::laser
