#include "problems/entropy/profile_form.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace odobench {
namespace {

// x and y side by side: one instruction on every processor with two double lanes.
typedef double Pair __attribute__((vector_size(16)));

Pair pair(double x, double y) {
  return Pair{x, y};
}

// sum_n P_in P_jn with P_jn = max(0, n - 1 - j).
double ramp_product(int samples, int i, int j) {
  double sum = 0;
  for (int n = 1; n <= samples; ++n) sum += std::max(0, n - 1 - i) * std::max(0, n - 1 - j);
  return sum;
}

// Z_j = sum_n (n - 1) P_jn.
double ramp_moment(int samples, int j) {
  double sum = 0;
  for (int n = 1; n <= samples; ++n) sum += (n - 1) * std::max(0, n - 1 - j);
  return sum;
}

// Accelerations in x and y, interleaved, then rotations.
std::vector<QuadraticBlock> blocks_of(const Eigen::MatrixXd& qx, const Eigen::MatrixXd& qr) {
  std::vector<QuadraticBlock> blocks(3);
  const auto turns = static_cast<int>(qx.rows());
  for (int j = 0; j < turns; ++j) {
    blocks[0].index.push_back(2 * j);
    blocks[1].index.push_back(2 * j + 1);
  }
  for (int m = 0; m < static_cast<int>(qr.rows()); ++m) blocks[2].index.push_back(2 * turns + m);
  blocks[0].q = blocks[1].q = qx;
  blocks[2].q = qr;
  for (QuadraticBlock& block : blocks)
    block.g = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(block.index.size()));
  return blocks;
}

}  // namespace

ProfileForm::ProfileForm(const EntropyConstants& constants) : constants_(constants) {
  validate(constants_);
  const int n = constants_.samples;
  const double t = constants_.dt * constants_.dt;
  time_squared_ = t;
  encoder_weight_ = 1.0 / (constants_.sigma_encoder * constants_.sigma_encoder);
  acceleration_weight_ = 1.0 / (constants_.sigma_acceleration * constants_.sigma_acceleration);
  rotation_weight_ = 1.0 / (constants_.sigma_rotation * constants_.sigma_rotation);
  k_ = degrees_per_metre(constants_);
  r_weight_ = 4.0 * encoder_weight_ + k_ * k_ * rotation_weight_;
  scale_xy_ = 2.0 * constants_.step_acceleration;
  scale_r_ = 2.0 * r_weight_ * (t * constants_.step_rotation / k_);

  const double k11 = 4.0 * n * encoder_weight_;
  const double k12 = 2.0 * t * n * (n - 1) * encoder_weight_;
  const double k22 =
      (n - 1) * acceleration_weight_ + 2.0 / 3.0 * t * t * (n - 1) * n * (2.0 * n - 1) * encoder_weight_;
  // det K = k11 k22 - k12^2 without the cancellation: 4N (N-1) / (se^2 sa^2) + 4/3 N^2 (N^2-1) T^2 / se^4.
  const double determinant = 4.0 * n * (n - 1) * encoder_weight_ * acceleration_weight_ +
                             4.0 / 3.0 * n * n * (n * n - 1.0) * t * t * encoder_weight_ * encoder_weight_;
  inverse_k_[0] = k22 / determinant;
  inverse_k_[1] = -k12 / determinant;
  inverse_k_[2] = k11 / determinant;

  const int turns = n - 2;
  Eigen::MatrixXd qx(turns, turns), b(2, turns), kb(2, turns);
  for (int j = 1; j <= turns; ++j) {
    const double s = (n - 1 - j) * (n - j) / 2.0;
    b(0, j - 1) = 4.0 * t * s * encoder_weight_;
    b(1, j - 1) = (n - 1 - j) * acceleration_weight_ + 4.0 * t * t * ramp_moment(n, j) * encoder_weight_;
    kb(0, j - 1) = inverse_k_[0] * b(0, j - 1) + inverse_k_[1] * b(1, j - 1);
    kb(1, j - 1) = inverse_k_[1] * b(0, j - 1) + inverse_k_[2] * b(1, j - 1);
    shift_of_s1_.push_back(kb(0, j - 1) * constants_.step_acceleration);
    shift_of_a12_.push_back(kb(1, j - 1) * constants_.step_acceleration);
  }
  const double step2 = constants_.step_acceleration * constants_.step_acceleration;
  for (int i = 1; i <= turns; ++i)
    for (int j = 1; j <= i; ++j) {
      const double value =
          step2 * ((n - 1 - i) * acceleration_weight_ +
                   4.0 * t * t * encoder_weight_ * ramp_product(n, i, j) - b.col(i - 1).dot(kb.col(j - 1)));
      qx(i - 1, j - 1) = qx(j - 1, i - 1) = value;
    }
  Eigen::MatrixXd qr(n - 1, n - 1);
  const double turn = t * constants_.step_rotation / k_;
  for (int i = 1; i < n; ++i)
    for (int j = 1; j < n; ++j)
      qr(i - 1, j - 1) =
          r_weight_ * turn * turn * (n - std::max(i, j) - (n - i) * (n - j) / static_cast<double>(n));
  for (int m = 1; m < n; ++m) shift_of_r1_.push_back(turn / n * (n - m));

  blocks_ = blocks_of(qx, qr);
}

WindowZero ProfileForm::linear_term(const SampleModes* window, std::span<double> g) const {
  const int n = constants_.samples;
  const double t = time_squared_;
  // At the zero-increment optimum the residuals of (2.29) are orthogonal to what r1, s1 and a12 do, so that
  // g is twice their product with what an increment does.
  Pair sum = pair(0, 0), moment = pair(0, 0), acceleration = pair(0, 0);
  double rest = 0, rho = 0;
  for (int i = 0; i < n; ++i) {
    const SampleModes& m = window[i];
    const Pair s = pair(m.x, m.y);
    sum += s;
    moment += static_cast<double>(i) * s;
    if (i > 0) acceleration += pair(m.cax, m.cay);
    rho += m.rho;
    rest += m.rest;
  }
  const Pair c1 = encoder_weight_ * sum;
  const Pair c2 = acceleration_weight_ * acceleration + t * encoder_weight_ * moment;
  const Pair s1 = inverse_k_[0] * c1 + inverse_k_[1] * c2;
  const Pair a12 = inverse_k_[1] * c1 + inverse_k_[2] * c2;
  const double mean = rho / n;

  // Downwards over the samples: sums over the later ones, and sums of those.
  Pair squares_e = pair(0, 0), squares_a = pair(0, 0), later_a = pair(0, 0);
  Pair later_e = pair(0, 0), ramp_e = pair(0, 0);
  const Pair acceleration_scale = scale_xy_ * acceleration_weight_ + pair(0, 0);
  const Pair encoder_scale = 4.0 * t * encoder_weight_ * scale_xy_ + pair(0, 0);
  double later_r = 0, squares_r = 0;
  double* const gx = g.data();
  double* const gy = gx + (n - 2);
  double* const gr = gy + (n - 2);
  for (int i = n - 1; i > 0; --i) {
    const SampleModes& m = window[i];
    const double turned = m.rho - mean;
    later_r += turned;
    squares_r += turned * turned;
    gr[i - 1] = scale_r_ * later_r;

    const Pair a = pair(m.cax, m.cay) - a12;
    const Pair e = 0.25 * pair(m.x, m.y) - (s1 + t * static_cast<double>(i) * a12);
    squares_a += a * a;
    squares_e += e * e;
    later_a += a;
    later_e += e;
    ramp_e += later_e;
    if (i < 2) continue;
    // Increment j = i - 1 acts on the accelerations m > j, those of samples >= i here, and with P_jn = i' - j
    // on them.
    const Pair value = acceleration_scale * later_a + encoder_scale * ramp_e;
    gx[i - 2] = value[0];
    gy[i - 2] = value[1];
  }
  const SampleModes& first = window[0];
  const Pair e = 0.25 * pair(first.x, first.y) - s1;
  squares_e += e * e;
  squares_r += (first.rho - mean) * (first.rho - mean);
  WindowZero zero;
  zero.h0 = -rest - r_weight_ * squares_r - 4.0 * encoder_weight_ * (squares_e[0] + squares_e[1]) -
            acceleration_weight_ * (squares_a[0] + squares_a[1]);
  zero.state = {mean, s1[0], s1[1], a12[0], a12[1]};
  return zero;
}

EntropyState ProfileForm::closed_form(const WindowZero& zero, std::span<const double> t) const {
  EntropyState state = zero.state;
  const std::size_t turns = shift_of_s1_.size();
  for (std::size_t j = 0; j < turns; ++j) {
    state.sx1 -= shift_of_s1_[j] * t[j];
    state.sy1 -= shift_of_s1_[j] * t[turns + j];
    state.ax12 -= shift_of_a12_[j] * t[j];
    state.ay12 -= shift_of_a12_[j] * t[turns + j];
  }
  for (std::size_t m = 0; m < shift_of_r1_.size(); ++m) state.r1 -= shift_of_r1_[m] * t[2 * turns + m];
  return state;
}

BlockQuadratic ProfileForm::cost(const EntropyWindow& window) const {
  validate(window);
  if (window.constants != constants_)
    throw std::invalid_argument("window '" + window.id + "': its constants are not those of the profile");
  ModeReader reader(*this);
  std::vector<SampleModes> modes;
  for (const EntropySample& sample : window.samples) modes.push_back(reader.read(sample));
  std::vector<double> g(static_cast<std::size_t>(increment_count(constants_.samples)));
  BlockQuadratic cost{-linear_term(modes.data(), g).h0, blocks_};
  const double* from = g.data();
  for (QuadraticBlock& block : cost.blocks)
    for (Eigen::Index i = 0; i < block.g.size(); ++i) block.g[i] = *from++;
  return cost;
}

ModeReader::ModeReader(const ProfileForm& profile) : profile_(profile), alpha_(alpha(profile.constants())) {
  steering_.fill(std::nan(""));
}

SampleModes ModeReader::read(const EntropySample& sample) {
  if (sample.steering != steering_) {  // usually the wheels keep their angles, and trigonometry is slow
    steering_ = sample.steering;
    for (std::size_t w = 0; w < 4; ++w) {
      cos_[w] = std::cos(steering_[w] + alpha_);
      sin_[w] = std::sin(steering_[w] + alpha_);
    }
    turn_ = {sin_[0], -std::sin(steering_[1] - alpha_), -sin_[2], std::sin(steering_[3] - alpha_)};
  }
  const ProfileForm& p = profile_;
  SampleModes m;
  double squares = 0, turn = 0;
  for (std::size_t w = 0; w < 4; ++w) {
    m.x += sample.wheel[w] * cos_[w];
    m.y += sample.wheel[w] * sin_[w];
    turn += sample.wheel[w] * turn_[w];
    squares += sample.wheel[w] * sample.wheel[w];
  }
  m.rho = (turn * p.encoder_weight_ + p.k_ * sample.rotation * p.rotation_weight_) / p.r_weight_;
  const double encoder = 0.25 * turn - m.rho, gyro = sample.rotation - p.k_ * m.rho;
  m.rest =
      (squares - 0.25 * (m.x * m.x + m.y * m.y + turn * turn) + 4.0 * encoder * encoder) * p.encoder_weight_ +
      gyro * gyro * p.rotation_weight_;
  m.cax = 0.5 * (ax_ + sample.ax);
  m.cay = 0.5 * (ay_ + sample.ay);
  ax_ = sample.ax;
  ay_ = sample.ay;
  return m;
}

SampleHistory::SampleHistory(const ProfileForm& profile)
    : reader_(profile),
      samples_(static_cast<std::size_t>(profile.constants().samples)),
      modes_(std::max<std::size_t>(64, 8 * samples_)) {}

void SampleHistory::push(const EntropySample& sample) {
  if (end_ == modes_.size()) {
    std::copy(modes_.begin() + static_cast<std::ptrdiff_t>(begin_), modes_.end(), modes_.begin());
    end_ -= begin_;
    begin_ = 0;
  }
  if (end_ - begin_ == samples_) ++begin_;
  modes_[end_++] = reader_.read(sample);
}

}  // namespace odobench
