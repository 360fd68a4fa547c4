#include "holdfast/registration/correspondences.hpp"

#include "holdfast/registration/associate.hpp"

namespace holdfast::registration {

void Correspondences::resize(std::size_t n) {
  for (auto* column : {&px, &py, &pz, &nx, &ny, &nz, &offset, &information, &age_s}) {
    column->resize(n);
  }
}

template std::size_t associate(const map::PriorMap& map, const SE3& T_anchor_body,
                               const Eigen::Vector3d& p_body_lidar, const BodyPoints& points,
                               const AssociationOptions& options, WorkerPool& pool,
                               Correspondences& out);

}  // namespace holdfast::registration
