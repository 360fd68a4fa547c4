#include "holdfast/registration/point_to_line.hpp"

#include <Eigen/Geometry>

namespace holdfast::registration {
namespace {

void append(const Eigen::Vector3f& q, float age_s, const Eigen::Vector3f& normal, float offset,
            float variance, Correspondences& out) {
  out.px.push_back(q.x());
  out.py.push_back(q.y());
  out.pz.push_back(q.z());
  out.nx.push_back(normal.x());
  out.ny.push_back(normal.y());
  out.nz.push_back(normal.z());
  out.offset.push_back(offset);
  out.information.push_back(1.0F / variance);
  out.age_s.push_back(age_s);
}

}  // namespace

void append_line_pair(const LineMatch& line, const Eigen::Vector3f& q, float age_s,
                      const Eigen::Vector3f& ray, const AssociationOptions& options,
                      Correspondences& out) {
  const Eigen::Vector3f& d = line.direction;
  const Eigen::Vector3f unit_ray = ray.normalized();
  Eigen::Vector3f across = unit_ray - unit_ray.dot(d) * d;
  const float part = across.norm();  // of a range error that shows across the line
  if (part > 1e-3F) {
    across /= part;
  } else {
    across = d.unitOrthogonal();  // seen end on: no range error shows
  }
  const Eigen::Vector3f aside = d.cross(across);
  const float least =
      line.sigma_m * line.sigma_m + options.surface_sigma_m * options.surface_sigma_m;
  const float range = options.range_sigma_m * part;
  append(q, age_s, across, across.dot(line.point), least + range * range, out);
  append(q, age_s, aside, aside.dot(line.point), least, out);
}

}  // namespace holdfast::registration
