// What fuse() does for one choice of states: a private header of fusion.cpp and the tuning problem.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <limits>

#include "problems/fusion/fusion.hpp"
#include "problems/fusion/robot_model.hpp"
#include "problems/kalman/consistency.hpp"

namespace odobench {

template <class Model>
class FusionEngine {
 public:
  FusionEngine(const Recording& recording, const ConstVectorRef& z, std::span<const SensorStream> sensors,
               const FusionOptions& options, bool keep_innovations)
      : recording_(recording),
        sensors_(sensors),
        options_(options),
        keep_(keep_innovations),
        filter_(Model(), options.filter, start(recording), start_covariance(options)) {
    for (std::size_t k = 0; k + 1 < recording.size(); ++k) twists_.push_back(wheel_twist(recording, k, z));
    for (int dof = 1; dof <= 3; ++dof)
      gates_[dof] =
          options.gate_probability > 0 ? chi_square_quantile(options.gate_probability, dof) : Filter::kNoGate;
    collect_events();
  }

  FusionResult run() {
    run_causal();
    if (options_.smooth) run_smoother();
    summarise();
    return std::move(result_);
  }

 private:
  using Filter = KalmanFilter<Model>;
  using State = typename Filter::State;
  using Square = typename Filter::Square;
  static constexpr int kN = Model::kStates;

  // A measurement in the order of stamps, and what became of it when it was used last.
  struct Event {
    std::size_t sensor = 0, index = 0;
    std::int64_t time = 0, arrival = 0;
    bool late = false;
    int dof = 0;  // 0: not used (the first relative pose)
    double nis = 0, log_det = 0;
    bool accepted = true;
    Eigen::Vector3d whitened = Eigen::Vector3d::Zero();
  };
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  // The filter at a stamp of the recording, ahead of the interval that begins there.
  struct Snapshot {
    State x;
    Square s;
    std::size_t gyro = kNone, pose = kNone;
    bool fresh_gyro = false;
  };

  static WalkingState walking(const std::optional<WalkingState>& w) { return w.value_or(WalkingState{}); }
  static State start(const Recording& recording) {
    State x = State::Zero();
    x[2] = recording.reference.theta.at(0);
    return Filter::kN == 3 ? x : State(Model::copy_map() * x);
  }
  static Matrix start_covariance(const FusionOptions& o) {
    State v = State::Zero();
    v[0] = v[1] = o.initial_position * o.initial_position;
    v[2] = o.initial_heading * o.initial_heading;
    if constexpr (Model::kHasBias) v[Model::kBias] = std::pow(walking(o.gyro_bias).initial, 2);
    if constexpr (Model::kHasScale) v[Model::kScale] = std::pow(walking(o.odometry_scale).initial, 2);
    const Matrix p = v.asDiagonal();
    return Model::kHasCopy ? Matrix(Model::copy_map() * p * Model::copy_map().transpose()) : p;
  }

  void collect_events() {
    const std::int64_t begin = recording_.time_us.front(), end = recording_.time_us.back();
    const auto most = static_cast<std::int64_t>(options_.max_delay_s * 1e6);
    for (std::size_t s = 0; s < sensors_.size(); ++s) {
      result_.sensors.push_back({sensors_[s].name});
      for (std::size_t i = 0; i < sensors_[s].data.size(); ++i) {
        const Measurement& m = sensors_[s].data[i];
        if (m.time_us < begin || m.time_us > end) {
          ++result_.sensors.back().outside;
          continue;
        }
        events_.push_back({s, i, m.time_us, m.arrival_us});
        events_.back().late = m.arrival_us - m.time_us > most;
      }
    }
    // Equal stamps: the order of the sensors, so that the result does not depend on the sort.
    std::sort(events_.begin(), events_.end(), [](const Event& a, const Event& b) {
      return a.time != b.time ? a.time < b.time : a.sensor < b.sensor;
    });
    // Interval k takes what is stamped in (t_k, t_{k+1}], the first one t_0 too.
    const std::size_t intervals = recording_.size() - 1;
    first_.assign(intervals + 1, events_.size());
    std::size_t e = 0;
    for (std::size_t k = 0; k < intervals; ++k) {
      first_[k] = e;
      while (e < events_.size() && events_[e].time <= recording_.time_us[k + 1]) ++e;
    }
    for (std::size_t i = 0; i < events_.size(); ++i)
      if (events_[i].arrival > events_[i].time && !events_[i].late) delayed_.push_back(i);
    std::sort(delayed_.begin(), delayed_.end(), [this](std::size_t a, std::size_t b) {
      return events_[a].arrival != events_[b].arrival ? events_[a].arrival < events_[b].arrival : a < b;
    });
  }

  Snapshot snapshot() const { return {filter_.state(), filter_.factor(), gyro_, pose_, fresh_gyro_}; }
  void restore(const Snapshot& s) {
    filter_.restore(s.x, s.s);
    gyro_ = s.gyro;
    pose_ = s.pose;
    fresh_gyro_ = s.fresh_gyro;
  }

  void run_causal() {
    const std::size_t n = recording_.size();
    result_.track.x.reserve(n);
    result_.track.y.reserve(n);
    result_.track.theta.reserve(n);
    result_.factors.reserve(n);
    const Snapshot first = snapshot();
    std::vector<Snapshot> past;
    if (!delayed_.empty()) past.assign(n, first);
    keep(result_.track, result_.factors, filter_.state(), filter_.factor());
    std::size_t next_delayed = 0;
    for (std::size_t k = 0; k + 1 < n; ++k) {
      const std::int64_t now = recording_.time_us[k + 1];
      std::size_t from = k;
      for (; next_delayed < delayed_.size() && events_[delayed_[next_delayed]].arrival <= now; ++next_delayed)
        from = std::min(from, interval_of(delayed_[next_delayed]));
      if (from < k) restore(past[from]);
      for (std::size_t j = from; j <= k; ++j) {
        run_interval(j, now, nullptr);
        if (!past.empty()) past[j + 1] = snapshot();
      }
      keep(result_.track, result_.factors, filter_.state(), filter_.factor());
    }
    if constexpr (Model::kHasBias)
      if (options_.gyro_bias) result_.gyro_bias = filter_.state()[Model::kBias];
    if constexpr (Model::kHasScale)
      if (options_.odometry_scale) result_.odometry_scale = filter_.state()[Model::kScale];
    if (options_.smooth) restore(first);
  }

  std::size_t interval_of(std::size_t event) const {
    const auto after = std::upper_bound(first_.begin(), first_.end() - 1, event);
    return static_cast<std::size_t>(after - first_.begin()) - 1;
  }

  template <class AnyState, class AnySquare>
  static void keep(PoseTrack& track, std::vector<Eigen::Matrix3d>& factors, const AnyState& x,
                   const AnySquare& s) {
    track.x.push_back(x[0]);
    track.y.push_back(x[1]);
    track.theta.push_back(x[2]);
    factors.push_back(s.template topLeftCorner<3, 3>());
  }

  void run_interval(std::size_t k, std::int64_t now, std::vector<PredictionRecord>* records) {
    std::int64_t time = recording_.time_us[k];
    for (std::size_t e = first_[k]; e < first_[k + 1]; ++e) {
      Event& event = events_[e];
      if (event.late || event.arrival > now) continue;
      advance(k, time, event.time, records);
      time = event.time;
      use(event, e);
    }
    advance(k, time, recording_.time_us[k + 1], records);
  }

  void advance(std::size_t k, std::int64_t from, std::int64_t to, std::vector<PredictionRecord>* records) {
    if (to == from) return;
    const double dt = static_cast<double>(to - from) * 1e-6;
    const double part = static_cast<double>(recording_.time_us[k + 1] - recording_.time_us[k]) * 1e-6 / dt;
    const double spread = std::sqrt(part);
    typename Filter::NoiseFactor lq = Filter::NoiseFactor::Zero();
    lq(0, 0) = lq(1, 1) = options_.sigma_velocity * spread;
    lq(2, 2) = options_.sigma_yaw_rate * spread;
    if (options_.wheel_noise) lq.template topLeftCorner<3, 3>() = wheel_factor(twists_[k], dt);
    if constexpr (Model::kHasBias)
      lq(Model::kBias, Model::kBias) = walking(options_.gyro_bias).walk * std::sqrt(dt);
    if constexpr (Model::kHasScale)
      lq(Model::kScale, Model::kScale) = walking(options_.odometry_scale).walk * std::sqrt(dt);
    ProcessMeasurement<Model::kStates, Model::kNoises> reading;
    const bool has_reading = gyro_reading(k, from, dt, reading);
    PredictionRecord* record = nullptr;
    if (records != nullptr) record = &records->emplace_back();
    filter_.predict(twists_[k], lq, dt, has_reading ? &reading : nullptr, Filter::kNoGate, record);
  }

  // Of the variances of the twist over `dt`, lower triangular.
  Eigen::Matrix3d wheel_factor(const Twist& u, double dt) const {
    Eigen::Matrix3d q = twist_covariance(*options_.wheel_noise, u.vx, u.vy, u.omega, dt);
    q.diagonal().array() += kLeastWheelSigma * kLeastWheelSigma;
    return q.llt().matrixL();
  }
  // Variance of a sample's yaw rate.
  double yaw_rate_variance(std::size_t k) const {
    if (!options_.wheel_noise) return options_.sigma_yaw_rate * options_.sigma_yaw_rate;
    const double hold = static_cast<double>(recording_.time_us[k + 1] - recording_.time_us[k]) * 1e-6;
    const Twist& u = twists_[k];
    return twist_covariance(*options_.wheel_noise, u.vx, u.vy, u.omega, hold)(2, 2) +
           kLeastWheelSigma * kLeastWheelSigma;
  }

  // The gyro's sample in force, judged when it is used first.
  bool gyro_reading(std::size_t k, std::int64_t from, double dt,
                    ProcessMeasurement<Model::kStates, Model::kNoises>& reading) {
    if (gyro_ == kNone) return false;
    Event& event = events_[gyro_];
    const SensorStream& sensor = sensors_[event.sensor];
    if (from >= event.time + static_cast<std::int64_t>(sensor.hold_s * 1e6)) return false;
    reading = filter_.model().yaw_rate(filter_.state(), twists_[k].omega, sensor.data[event.index].value[0],
                                       sensor.sigma_rate * std::sqrt(std::max(1.0, sensor.hold_s / dt)));
    reading.touches_state = options_.gyro_bias.has_value();  // a bias without variance shares nothing
    if (fresh_gyro_) {
      fresh_gyro_ = false;
      double variance = yaw_rate_variance(k) + sensor.sigma_rate * sensor.sigma_rate;
      if constexpr (Model::kHasBias) variance += filter_.factor().row(Model::kBias).squaredNorm();
      event.dof = 1;
      event.nis = reading.innovation * reading.innovation / variance;
      event.log_det = std::log(variance);
      event.whitened[0] = reading.innovation / std::sqrt(variance);
      event.accepted = event.nis <= gates_[1];
    }
    return event.accepted;
  }

  void use(Event& event, std::size_t index) {
    const SensorStream& sensor = sensors_[event.sensor];
    const Eigen::Vector3d& z = sensor.data[event.index].value;
    switch (sensor.kind) {
      case SensorKind::YawRate:
        gyro_ = index;
        fresh_gyro_ = true;
        return;
      case SensorKind::Heading: {
        using One = Eigen::Matrix<double, 1, 1>;
        judge<1>(event, filter_.update(HeadingSensor<kN>(), One(z[2]), One(sensor.sigma_heading), gates_[1]));
        return;
      }
      case SensorKind::Pose:
        judge<3>(event, filter_.update(PoseSensor<kN>(), z, pose_factor(sensor), gates_[3]));
        return;
      case SensorKind::RelativePose:
        if constexpr (Model::kHasCopy) {
          if (pose_ != kNone) {
            const Eigen::Vector3d& before = sensor.data[events_[pose_].index].value;
            const double c = std::cos(before[2]), s = std::sin(before[2]);
            const Eigen::Vector3d d = z - before;
            const Eigen::Vector3d moved(c * d[0] + s * d[1], c * d[1] - s * d[0], wrapped_angle(d[2]));
            judge<3>(event, filter_.update(RelativePoseSensor<kN, Model::kCopy>(), moved, pose_factor(sensor),
                                           gates_[3]));
          }
          pose_ = index;
          filter_.transform(Model::copy_map());
        }
        return;
    }
  }

  static Eigen::Matrix3d pose_factor(const SensorStream& s) {
    return Eigen::Vector3d(s.sigma_position, s.sigma_position, s.sigma_heading).asDiagonal();
  }

  template <int Z>
  static void judge(Event& event, const Innovation<Z>& innovation) {
    event.dof = Z;
    event.nis = innovation.nis;
    event.log_det = innovation.log_det;
    event.accepted = innovation.accepted;
    event.whitened.template head<Z>() = forward_solved<Z, 1>(innovation.factor, innovation.nu);
  }

  // C = cov(x_k, x_k+1) P_k+1|k^-1, from the deviations E before and Y after a prediction (E Y' and Y Y'):
  //     x = x_k|k + C (x_s - x_k+1|k),   S = tri[ E - C Y, C S_s ]
  void run_smoother() {
    std::vector<PredictionRecord> records;
    std::vector<std::size_t> first_record;
    for (std::size_t k = 0; k + 1 < recording_.size(); ++k) {
      first_record.push_back(records.size());
      run_interval(k, std::numeric_limits<std::int64_t>::max(), &records);
    }
    // States without variance have no place in the inverse below.
    std::vector<Eigen::Index> active{0, 1, 2};
    if (Model::kHasBias && options_.gyro_bias) active.push_back(Model::kBias);
    if (Model::kHasScale && options_.odometry_scale) active.push_back(Model::kScale);
    const auto states = static_cast<Eigen::Index>(active.size());
    Vector x = filter_.state()(active);
    Matrix s = lower_triangular<Eigen::Dynamic, Eigen::Dynamic>(filter_.factor()(active, Eigen::all));
    const std::size_t n = recording_.size();
    PoseTrack& track = result_.smoothed;
    track.x.resize(n);
    track.y.resize(n);
    track.theta.resize(n);
    result_.smoothed_factors.resize(n);
    const auto put = [&](std::size_t k) {
      track.x[k] = x[0];
      track.y[k] = x[1];
      track.theta[k] = x[2];
      result_.smoothed_factors[k] = s.topLeftCorner<3, 3>();
    };
    put(n - 1);
    std::size_t r = records.size();
    for (std::size_t k = n - 1; k-- > 0;) {
      while (r > first_record[k]) {
        const PredictionRecord& record = records[--r];
        const Matrix e = record.before(active, Eigen::all), y = record.after(active, Eigen::all);
        const Matrix after = lower_triangular<Eigen::Dynamic, Eigen::Dynamic>(y);
        const Matrix ct = backward_solved<Eigen::Dynamic, Eigen::Dynamic>(
            after, forward_solved<Eigen::Dynamic, Eigen::Dynamic>(after, y * e.transpose()));
        const Matrix c = ct.transpose();
        x = (record.x(active) + c * (x - record.x_next(active))).eval();
        Matrix wide(states, y.cols() + states);
        wide << e - c * y, c * s;
        s = lower_triangular<Eigen::Dynamic, Eigen::Dynamic>(wide);
      }
      put(k);
    }
    if (!x.allFinite() || !s.allFinite())
      throw std::runtime_error("smoother: a covariance is singular; give the state some noise");
  }

  void summarise() {
    constexpr double kLogTwoPi = 1.8378770664093453;
    for (const Event& e : events_) {
      SensorStatistics& s = result_.sensors[e.sensor];
      if (e.late) ++s.late;
      if (e.late || e.dof == 0) continue;
      s.dof = e.dof;
      s.mean_nis += e.nis;
      if (sensors_[e.sensor].kind == SensorKind::YawRate)
        s.mean_innovation += e.whitened[0] * std::exp(0.5 * e.log_det);
      ++(e.accepted ? s.used : s.rejected);
      if (!e.accepted) continue;
      const double log_det = e.log_det + e.dof * kLogTwoPi;
      s.log_likelihood -= 0.5 * (e.nis + log_det);
      if (!keep_) continue;
      for (int i = 0; i < e.dof; ++i) result_.whitened.push_back(e.whitened[i]);
      result_.log_dets.push_back(log_det);
    }
    for (SensorStatistics& s : result_.sensors) {
      const auto judged = static_cast<double>(s.used + s.rejected);
      if (judged > 0) s.mean_nis /= judged, s.mean_innovation /= judged;
    }
  }

  const Recording& recording_;
  std::span<const SensorStream> sensors_;
  const FusionOptions& options_;
  bool keep_;
  Filter filter_;
  std::vector<Twist> twists_;
  std::vector<Event> events_;
  std::vector<std::size_t> first_;    // events_ of interval k begin at first_[k]
  std::vector<std::size_t> delayed_;  // indices of events_, in the order of arrival
  std::array<double, 4> gates_{};
  std::size_t gyro_ = kNone, pose_ = kNone;  // sample in force, pose before
  bool fresh_gyro_ = false;
  FusionResult result_;
};

}  // namespace odobench
