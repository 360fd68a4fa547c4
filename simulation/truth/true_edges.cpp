#include "simulation/truth/true_edges.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace holdfast::simulation {
namespace {

using Eigen::Vector3d;

constexpr double kTogether = 5e-4;  // metres between sides that run along each other

/// A side of a triangle.
struct Side {
  Segment line;
  Vector3d into;  ///< unit vector from the side into its triangle, at right angles to the side
};

std::vector<Side> sides_of(const World& world) {
  std::vector<Side> sides;
  for (const auto& triangle : world.triangles) {
    Vector3d p[3];
    for (int k = 0; k < 3; ++k) p[k] = world.vertices[triangle[k]].cast<double>();
    for (int k = 0; k < 3; ++k) {
      const Vector3d& a = p[k];
      const Vector3d& b = p[(k + 1) % 3];
      const Vector3d along = (b - a).normalized();
      const Vector3d to = p[(k + 2) % 3] - a;
      const Vector3d into = to - along.dot(to) * along;
      // Slivers have no side that could be told from the others.
      if ((b - a).norm() < 2 * kTogether || into.norm() < kTogether) continue;
      sides.push_back({{a, b}, into.normalized()});
    }
  }
  return sides;
}

/// Part of a side along which another side runs.
struct Contact {
  double begin;  ///< metres from the side's start
  double end;
  std::uint32_t side;
};

double off_line(const Vector3d& p, const Segment& line, const Vector3d& along) {
  return (p - line.a).cross(along).norm();
}

/// True when `other` runs along `side` for some length, which is put into `contact`.
bool touches(const Side& side, const Side& other, Contact& contact) {
  const double length = (side.line.b - side.line.a).norm();
  const Vector3d along = (side.line.b - side.line.a) / length;
  const double from = along.dot(other.line.a - side.line.a);
  const double to = along.dot(other.line.b - side.line.a);
  contact.begin = std::max(0.0, std::min(from, to));
  contact.end = std::min(length, std::max(from, to));
  if (contact.end - contact.begin < 2 * kTogether) return false;
  // The ends of the shorter one lie on the line of the longer one.
  const Vector3d other_way = other.line.b - other.line.a;
  if (other_way.norm() <= length) {
    return off_line(other.line.a, side.line, along) < kTogether &&
           off_line(other.line.b, side.line, along) < kTogether;
  }
  const Vector3d other_along = other_way.normalized();
  return off_line(side.line.a, other.line, other_along) < kTogether &&
         off_line(side.line.b, other.line, other_along) < kTogether;
}

class EdgeFinder {
 public:
  explicit EdgeFinder(const World& world)
      : sides_(sides_of(world)), grid_(lines_of(sides_)), smooth_cos_(std::cos(kSmoothAngle)) {}

  std::vector<Segment> edges() {
    for (std::uint32_t i = 0; i < sides_.size(); ++i) add_side(i);
    return std::move(edges_);
  }

 private:
  static std::vector<Segment> lines_of(const std::vector<Side>& sides) {
    std::vector<Segment> lines;
    for (const Side& side : sides) lines.push_back(side.line);
    return lines;
  }

  std::vector<Contact> contacts_of(std::uint32_t i) const {
    const auto& [a, b] = sides_[i].line;
    const int steps =
        std::max(1, static_cast<int>(std::ceil((b - a).norm() / SegmentGrid::kPiece)));
    std::vector<std::uint32_t> others;
    for (int k = 0; k < steps; ++k) {
      const Vector3d middle = a + (b - a) * (k + 0.5) / steps;
      grid_.near(middle, [&](const SegmentGrid::Piece& piece) { others.push_back(piece.of); });
    }
    std::sort(others.begin(), others.end());
    others.erase(std::unique(others.begin(), others.end()), others.end());
    std::vector<Contact> contacts;
    for (const std::uint32_t k : others) {
      Contact contact{0, 0, k};
      if (k != i && touches(sides_[i], sides_[k], contact)) contacts.push_back(contact);
    }
    return contacts;
  }

  /// Cuts side `i` where others begin or end, and keeps the parts that are edges. A part that
  /// another side before it in the list shares was dealt with there.
  void add_side(std::uint32_t i) {
    const auto contacts = contacts_of(i);
    const Segment& line = sides_[i].line;
    const double length = (line.b - line.a).norm();
    std::vector<double> cuts = {0, length};
    for (const Contact& contact : contacts) {
      cuts.push_back(contact.begin);
      cuts.push_back(contact.end);
    }
    std::sort(cuts.begin(), cuts.end());
    for (std::size_t k = 0; k + 1 < cuts.size(); ++k) {
      if (cuts[k + 1] - cuts[k] < 2 * kTogether) continue;
      const double middle = 0.5 * (cuts[k] + cuts[k + 1]);
      std::vector<Vector3d> faces = {sides_[i].into};
      bool known = false;
      for (const Contact& contact : contacts) {
        if (contact.begin > middle || contact.end < middle) continue;
        known = known || contact.side < i;
        faces.push_back(sides_[contact.side].into);
      }
      if (known || is_smooth(faces)) continue;
      const Vector3d along = (line.b - line.a) / length;
      edges_.push_back({line.a + cuts[k] * along, line.a + cuts[k + 1] * along});
    }
  }

  /// True when the faces around a line lie in one plane, and on both sides of it.
  bool is_smooth(const std::vector<Vector3d>& faces) const {
    bool goes_on = false;
    for (const Vector3d& face : faces) {
      const double cosine = face.dot(faces.front());
      if (std::abs(cosine) < smooth_cos_) return false;
      goes_on = goes_on || cosine < 0;
    }
    return goes_on;
  }

  std::vector<Side> sides_;
  SegmentGrid grid_;
  double smooth_cos_;
  std::vector<Segment> edges_;
};

}  // namespace

std::vector<Segment> true_edges(const World& world) { return EdgeFinder(world).edges(); }

}  // namespace holdfast::simulation
