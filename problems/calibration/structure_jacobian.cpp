// Residuals and Jacobian of the structured form, from the same streams as the kernels.
#include <cmath>

#include "problems/calibration/structure.hpp"

namespace odobench {
namespace {

using Eigen::Index;
using kernel::kHeading;
using kernel::kLinear;

// Derivatives of the poses of a few samples by (r, P, Q), then the columns of the Jacobian by z: it is
// written once, column by column, in pieces that stay in the first-level cache until then.
class JacobianRows {
 public:
  explicit JacobianRows(const LinearMatrix& chain) : chain_(chain) { rows_.setZero(); }

  void start() {
    gx_.setZero();
    gy_.setZero();
    heading_.setZero();
  }
  // A step whose wheels moved by c, s (C_i, S_i) at a heading with this cosine and sine, and the pose by
  // (mx, my).
  void add(const Eigen::Vector4d& c, const Eigen::Vector4d& s, double cosine, double sine, double mx,
           double my) {
    gx_.head<4>() += cosine * c - sine * s;
    gy_.head<4>() += sine * c + cosine * s;
    gx_.tail<kHeading>() -= my * heading_;
    gy_.tail<kHeading>() += mx * heading_;
    heading_.head<4>() -= c;
    heading_.tail<4>() += s;
    double* to = &rows_(3 * filled_, 0);
    for (Index i = 0; i < kLinear; ++i, to += rows_.rows()) {
      to[0] = gx_[i];
      to[1] = gy_[i];
      if (i >= kLinear - kHeading) to[2] = heading_[i - (kLinear - kHeading)];
    }
    ++filled_;
  }
  bool full() const { return filled_ == kSamples; }

  // Writes what was added into the rows of the Jacobian from `row` on; gives the next row.
  Index write(Index row, MatrixRef j) {
    const Index count = 3 * filled_;
    const auto by = [&](Index i) { return rows_.col(i).head(count); };
    for (Index i = 0; i < 4; ++i) {
      const Index p = 4 + i, q = 8 + i;
      for (const Index z : {i, p}) j.col(z).segment(row, count) = chain_(p, z) * by(p) + chain_(q, z) * by(q);
      j.col(q).segment(row, count) = chain_(i, q) * by(i) + chain_(p, q) * by(p) + chain_(q, q) * by(q);
    }
    filled_ = 0;
    return row + count;
  }

 private:
  static constexpr Index kSamples = 64;
  const LinearMatrix& chain_;
  LinearVector gx_, gy_;
  HeadingVector heading_;
  Index filled_ = 0;
  Eigen::Matrix<double, 3 * kSamples, kLinear> rows_;
};

}  // namespace

void CalibrationStructure::residuals_and_jacobian(const std::vector<Recording>& recordings,
                                                  const ConstVectorRef& z, VectorRef r, MatrixRef j) const {
  const LinearVector s = linear_parameters(z);
  const LinearMatrix chain = linear_jacobian(z);
  JacobianRows rows(chain);
  Index row = 0, written = 0;
  for (std::size_t i = 0; i < plans_.size(); ++i) {
    const Reference& reference = recordings[i].reference;
    double x = 0, y = 0, theta = plans_[i].theta0;
    std::size_t sample = 0;
    rows.start();
    for (const BlockPlan& block : plans_[i].blocks)
      for (long k = 0; k < block.steps * block.width; ++k) {
        // Segments one after the other, each in its lane.
        const auto place =
            static_cast<std::size_t>(k % block.steps * kernel::kStreams * block.width + k / block.steps);
        const double* step = &data_[block.data + place];
        Eigen::Vector4d c, w;
        for (Index wheel = 0; wheel < 4; ++wheel) {
          c[wheel] = step[wheel * block.width];
          w[wheel] = step[(4 + wheel) * block.width];
        }
        const double cosine = std::cos(theta), sine = std::sin(theta);
        const double ux = s.head<4>().dot(c), uy = s.head<4>().dot(w);
        const double mx = cosine * ux - sine * uy, my = sine * ux + cosine * uy;
        x += mx;
        y += my;
        theta += s.tail<4>().dot(w) - s.segment<4>(4).dot(c);
        rows.add(c, w, cosine, sine, mx, my);
        ++sample;
        r.segment<3>(row) << x - reference.x[sample], y - reference.y[sample],
            theta - reference.theta[sample];
        row += 3;
        if (rows.full()) written = rows.write(written, j);
      }
  }
  rows.write(written, j);
}

}  // namespace odobench
