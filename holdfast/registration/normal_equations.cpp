#include "holdfast/registration/normal_equations.hpp"

namespace holdfast::registration {
namespace {

constexpr std::size_t kChunk = 1024;
constexpr int kLanes = 8;
using Lane = Eigen::Array<float, kLanes, 1>;
using Load = Eigen::Map<const Lane>;

/// Products of the Jacobian [n, m, age n] with itself, where m = q x (R^T n): the blocks of H that
/// are not copies of each other.
struct LaneSums {
  Lane nn[6], nm[9], mm[6];               // H of position and rotation
  Lane nn_age[6], nm_age[9], nn_age2[6];  // and of velocity
  Lane n_r[3], m_r[3], n_r_age[3];
  Lane cost, weight, abs_residual, pairs;

  LaneSums() {
    Lane* all = reinterpret_cast<Lane*>(this);
    for (std::size_t i = 0; i < sizeof(LaneSums) / sizeof(Lane); ++i) all[i].setZero();
  }
};

/// The pose in float, as the lanes use it.
struct Pose {
  Eigen::Matrix3f R;
  Eigen::Vector3f t;
};

void add_symmetric(Lane (&sums)[6], const Lane (&a)[3], const Lane (&b)[3]) {
  sums[0] += a[0] * b[0];
  sums[1] += a[0] * b[1];
  sums[2] += a[0] * b[2];
  sums[3] += a[1] * b[1];
  sums[4] += a[1] * b[2];
  sums[5] += a[2] * b[2];
}

void add_full(Lane (&sums)[9], const Lane (&a)[3], const Lane (&b)[3]) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) sums[3 * i + j] += a[i] * b[j];
  }
}

/// Adds pairs [i, i + 8) to the sums.
void add_lanes(const Correspondences& c, std::size_t i, const Pose& pose, float scale_sq,
               LaneSums& s) {
  const Load qx(&c.px[i]), qy(&c.py[i]), qz(&c.pz[i]), age(&c.age_s[i]);
  const Load information(&c.information[i]);
  const Lane n[3] = {Load(&c.nx[i]), Load(&c.ny[i]), Load(&c.nz[i])};
  const auto& R = pose.R;
  // u = R^T n, the normal in the body frame: n . R q = u . q
  const Lane ux = R(0, 0) * n[0] + R(1, 0) * n[1] + R(2, 0) * n[2];
  const Lane uy = R(0, 1) * n[0] + R(1, 1) * n[1] + R(2, 1) * n[2];
  const Lane uz = R(0, 2) * n[0] + R(1, 2) * n[1] + R(2, 2) * n[2];
  const Lane r = ux * qx + uy * qy + uz * qz + pose.t.x() * n[0] + pose.t.y() * n[1] +
                 pose.t.z() * n[2] - Load(&c.offset[i]);
  const Lane k_sq = r * r * information;
  const Lane shrink = scale_sq / (scale_sq + k_sq);
  const Lane robust = shrink * shrink;
  const Lane w = robust * information;
  const Lane m[3] = {qy * uz - qz * uy, qz * ux - qx * uz, qx * uy - qy * ux};
  const Lane wn[3] = {w * n[0], w * n[1], w * n[2]};
  const Lane wm[3] = {w * m[0], w * m[1], w * m[2]};
  const Lane wna[3] = {wn[0] * age, wn[1] * age, wn[2] * age};
  const Lane na[3] = {n[0] * age, n[1] * age, n[2] * age};
  add_symmetric(s.nn, wn, n);
  add_full(s.nm, wn, m);
  add_symmetric(s.mm, wm, m);
  add_symmetric(s.nn_age, wna, n);
  add_full(s.nm_age, wna, m);
  add_symmetric(s.nn_age2, wna, na);
  for (int k = 0; k < 3; ++k) {
    s.n_r[k] += wn[k] * r;
    s.m_r[k] += wm[k] * r;
    s.n_r_age[k] += wna[k] * r;
  }
  const Lane found = (information > 0.0F).cast<float>();
  s.cost += shrink * k_sq * found;
  s.weight += robust * found;
  s.abs_residual += robust * found * r.abs();
  s.pairs += found;
}

Eigen::Matrix3d symmetric(const Lane (&sums)[6]) {
  Eigen::Matrix3d m;
  m << sums[0].sum(), sums[1].sum(), sums[2].sum(), sums[1].sum(), sums[3].sum(), sums[4].sum(),
      sums[2].sum(), sums[4].sum(), sums[5].sum();
  return m;
}

Eigen::Matrix3d full(const Lane (&sums)[9]) {
  Eigen::Matrix3d m;
  for (int i = 0; i < 9; ++i) m(i / 3, i % 3) = sums[i].sum();
  return m;
}

Eigen::Vector3d vector(const Lane (&sums)[3]) {
  return {sums[0].sum(), sums[1].sum(), sums[2].sum()};
}

NormalEquations total(const LaneSums& s) {
  NormalEquations e;
  e.H.block<3, 3>(kPosition, kPosition) = symmetric(s.nn);
  e.H.block<3, 3>(kPosition, kRotation) = full(s.nm);
  e.H.block<3, 3>(kRotation, kRotation) = symmetric(s.mm);
  e.H.block<3, 3>(kPosition, kVelocity) = symmetric(s.nn_age);
  e.H.block<3, 3>(kRotation, kVelocity) = full(s.nm_age).transpose();
  e.H.block<3, 3>(kVelocity, kVelocity) = symmetric(s.nn_age2);
  e.H.triangularView<Eigen::StrictlyLower>() = e.H.transpose();
  e.g.segment<3>(kPosition) = vector(s.n_r);
  e.g.segment<3>(kRotation) = vector(s.m_r);
  e.g.segment<3>(kVelocity) = vector(s.n_r_age);
  e.cost = s.cost.sum();
  e.weight = s.weight.sum();
  e.abs_residual = s.abs_residual.sum();
  e.pairs = s.pairs.sum();
  return e;
}

/// The last pairs of a range, filled up with empty ones.
Correspondences padded_tail(const Correspondences& c, std::size_t begin, std::size_t end) {
  Correspondences tail;
  tail.resize(kLanes);
  for (std::size_t i = begin; i < end; ++i) {
    const std::size_t k = i - begin;
    tail.px[k] = c.px[i];
    tail.py[k] = c.py[i];
    tail.pz[k] = c.pz[i];
    tail.nx[k] = c.nx[i];
    tail.ny[k] = c.ny[i];
    tail.nz[k] = c.nz[i];
    tail.offset[k] = c.offset[i];
    tail.information[k] = c.information[i];
    tail.age_s[k] = c.age_s[i];
  }
  return tail;
}

}  // namespace

NormalEquations& NormalEquations::operator+=(const NormalEquations& other) {
  H += other.H;
  g += other.g;
  cost += other.cost;
  weight += other.weight;
  abs_residual += other.abs_residual;
  pairs += other.pairs;
  return *this;
}

NormalEquations linearise(const Correspondences& pairs, const SE3& T_anchor_body,
                          double robust_scale, WorkerPool& pool,
                          std::vector<NormalEquations>& partials) {
  const Pose pose{T_anchor_body.rotation.toRotationMatrix().cast<float>(),
                  T_anchor_body.translation.cast<float>()};
  const auto scale_sq = static_cast<float>(robust_scale * robust_scale);
  return ordered_sum(pool, pairs.size(), kChunk, partials, NormalEquations{},
                     [&](std::size_t begin, std::size_t end) {
                       LaneSums sums;
                       std::size_t i = begin;
                       for (; i + kLanes <= end; i += kLanes) {
                         add_lanes(pairs, i, pose, scale_sq, sums);
                       }
                       if (i < end) add_lanes(padded_tail(pairs, i, end), 0, pose, scale_sq, sums);
                       return total(sums);
                     });
}

}  // namespace holdfast::registration
