#include "limcycle/models/measured/vector_fit.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "limcycle/models/linear/dense.hpp"

namespace limcycle {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int most_iterations = 30;
constexpr double least_damping = 1e-9;  ///< of a pole, over its size: the basis needs poles beside the axis

/// Starting poles: lightly damped pairs, spread over the logarithm of the band (Gustavsen and Semlyen 1999).
std::vector<Complex> starting_poles(int count, double from, double to) {
  std::vector<Complex> poles;
  const int pairs = count / 2;
  for (int i = 0; i < pairs; ++i) {
    const double share = pairs == 1 ? 0.5 : static_cast<double>(i) / (pairs - 1);
    const double w = from * std::pow(to / from, share);
    poles.emplace_back(-0.01 * w, w);
  }
  if (count % 2 == 1) poles.emplace_back(-std::sqrt(from * to), 0.0);
  return poles;
}

/// One of each pair, and mirrored into the left half plane.
std::vector<Complex> stable(const Eigen::VectorXcd& roots) {
  std::vector<Complex> poles;
  for (const Complex& root : roots) {
    const double size = std::abs(root);
    if (root.imag() < 0.0 || !(size > 0.0) || !std::isfinite(size)) continue;
    poles.emplace_back(-std::max(std::abs(root.real()), least_damping * size), root.imag());
  }
  std::ranges::sort(poles, {}, [](const Complex& pole) { return std::pair(std::abs(pole), pole.imag()); });
  return poles;
}

/// Orthonormal columns of all c with B c = 0.
MatrixXd beside(const VectorXd& B) {
  const Index n = B.size();
  VectorXd mirror = B / B.norm();  // Householder: takes B to an axis, of which the others are beside B
  mirror(0) += mirror(0) < 0.0 ? -1.0 : 1.0;
  const MatrixXd turn = MatrixXd::Identity(n, n) - 2.0 / mirror.squaredNorm() * mirror * mirror.transpose();
  return turn.rightCols(n - 1);
}

/// Least squares with columns brought to one size first. The many rows become a triangle by QR, which then is solved
/// with pivots: an order higher than that of exact data leaves columns that depend on each other.
VectorXd scaled_least_squares(const MatrixXd& rows, const VectorXd& right) {
  const Index m = rows.cols();
  VectorXd sizes = rows.colwise().norm().transpose();
  for (double& size : sizes)
    if (!(size > 0.0)) size = 1.0;
  MatrixXd all(rows.rows(), m + 1);
  all << rows * sizes.cwiseInverse().asDiagonal(), right;
  const Eigen::HouseholderQR<Eigen::Ref<MatrixXd>> qr(all);
  const MatrixXd triangle = all.topRows(std::min(m + 1, all.rows())).triangularView<Eigen::Upper>();
  return least_squares(triangle.leftCols(m), triangle.col(m)).cwiseQuotient(sizes);
}

/// The data in units of a frequency in the middle of the band, and the iteration on them.
class Fitting {
 public:
  Fitting(const FrequencyData& data, const FitShape& shape)
      : data_(data), shape_(shape), scale_(std::sqrt(data.frequency.front() * data.frequency.back())) {
    const std::size_t n = data.size();
    double least = 0.0;
    if (!data.deviation.empty()) {
      std::vector<double> sorted = data.deviation;
      std::ranges::sort(sorted);
      least = 1e-3 * sorted[n / 2];  // a single point that claims to be exact must not be all that counts
    }
    for (std::size_t i = 0; i < n; ++i) {
      const double deviation = data.deviation.empty() ? 1.0 : std::max(data.deviation[i], least);
      weight_.push_back(1.0 / (std::abs(data.response[i]) * (deviation > 0.0 ? deviation : 1.0)));
      points_.emplace_back(0.0, data.frequency[i] / scale_);
    }
  }

  VectorFit run() {
    const double from = data_.frequency.front() / scale_, to = data_.frequency.back() / scale_;
    Trial trial{{starting_poles(shape_.order - shape_.poles_at_zero, from, to), shape_.poles_at_zero}};
    VectorFit best;
    best.misfit = std::numeric_limits<double>::infinity();
    int since = 0, iteration = 0;
    for (; iteration <= most_iterations && since < 5; ++iteration) {
      if (iteration > 0) trial.poles.stable = relocated(trial);
      if (trial.poles.order() != shape_.order) break;  // a pole went to zero or to infinity
      set_rows(trial);
      const double before = best.misfit;
      consider(trial, best);
      since = best.misfit < 0.999 * before ? 0 : since + 1;
    }
    best.iterations = iteration;
    best.shape = shape_;
    if (best.model.states() > 0) best.error = error_of(best.model);
    return best;
  }

 private:
  /// Poles, with the rows of weight * function of all points, the real parts first, in the directions that the relative
  /// degree leaves free.
  struct Trial {
    Poles poles;
    MatrixXd free = {}, rows = {};
  };

  void set_rows(Trial& trial) const {
    const PoleBasis basis(trial.poles);
    trial.free = shape_.relative_degree > 1 ? beside(basis.B) : MatrixXd::Identity(basis.size(), basis.size());
    const Index n = std::ssize(points_);
    MatrixXd rows(2 * n, basis.size());
    for (Index i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Eigen::VectorXcd functions = weight_[at] * basis.at(points_[at]);
      rows.row(i) = functions.real();
      rows.row(n + i) = functions.imag();
    }
    trial.rows = rows * trial.free;
  }

  VectorXd weighted_data() const {
    const Index n = std::ssize(points_);
    VectorXd right(2 * n);
    for (Index i = 0; i < n; ++i) {
      const Complex G = weight_[static_cast<std::size_t>(i)] * data_.response[static_cast<std::size_t>(i)];
      right(i) = G.real();
      right(n + i) = G.imag();
    }
    return right;
  }

  std::vector<Complex> relocated(const Trial& trial) const {
    if (trial.poles.stable.empty()) return {};
    const PoleBasis own({trial.poles.stable, 0});
    const Index n = std::ssize(points_), left = trial.rows.cols(), m = own.size();
    MatrixXd rows = MatrixXd::Zero(2 * n + 1, left + m + 1);
    VectorXd right = VectorXd::Zero(2 * n + 1);
    rows.topLeftCorner(2 * n, left) = trial.rows;
    double size = 0.0;
    Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(m + 1);
    for (Index i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      const Complex G = weight_[at] * data_.response[at];
      Eigen::VectorXcd sigma(m + 1);
      sigma << own.at(points_[at]), Complex(1.0, 0.0);
      rows.row(i).tail(m + 1) = -(G * sigma).real();
      rows.row(n + i).tail(m + 1) = -(G * sigma).imag();
      sum += sigma.real();
      size += std::norm(G);
    }
    // Relaxed: not sigma(inf) = 1 but the sum of Re sigma = the number of points, weighted like the data.
    const double weight = std::sqrt(size) / static_cast<double>(n);
    rows.row(2 * n).tail(m + 1) = weight * sum;
    right(2 * n) = weight * static_cast<double>(n);
    const VectorXd x = scaled_least_squares(rows, right);
    double d = x(left + m);
    const VectorXd c = x.segment(left, m);
    if (const double least = 1e-8 * c.norm(); std::abs(d) < least) d = d < 0.0 ? -least : least;
    if (!x.allFinite() || d == 0.0) return {};
    return stable(eigenvalues(own.A - own.B * (c / d).transpose()));
  }

  /// The numerator over these poles; kept if it is the best so far.
  void consider(const Trial& trial, VectorFit& best) const {
    const VectorXd right = weighted_data(), c = scaled_least_squares(trial.rows, right);
    const double misfit = (trial.rows * c - right).squaredNorm() / static_cast<double>(right.size());
    if (!c.allFinite() || !(misfit < best.misfit)) return;
    best.misfit = misfit;
    // In seconds: d/dt = scale d/d(scale t).
    const PoleBasis basis(trial.poles);
    best.model = {scale_ * basis.A, scale_ * basis.B, (trial.free * c).transpose(), MatrixXd::Zero(1, 1)};
  }

  FitError error_of(const StateSpace& model) const {
    FitError error;
    double squares = 0.0, weighted = 0.0;
    for (std::size_t i = 0; i < data_.size(); ++i) {
      const double distance = std::abs(response_of(model, data_.frequency[i]) / data_.response[i] - 1.0);
      squares += distance * distance;
      if (!data_.deviation.empty() && data_.deviation[i] > 0.0)
        weighted += distance * distance / (2.0 * data_.deviation[i] * data_.deviation[i]);
      if (!(distance <= error.largest)) {
        error.largest = distance;
        error.at = data_.frequency[i];
      }
    }
    const auto n = static_cast<double>(data_.size());
    error.rms = std::sqrt(squares / n);
    if (!data_.deviation.empty()) error.deviations = std::sqrt(weighted / n);
    return error;
  }

  const FrequencyData& data_;
  FitShape shape_;
  double scale_;
  std::vector<double> weight_;
  std::vector<Complex> points_;
};

}  // namespace

std::complex<double> response_of(const StateSpace& model, double w) { return model.at({0.0, w})(0, 0); }

int least_points(int order) { return (3 * order + 3) / 2 + 1; }

VectorFit vector_fit(const FrequencyData& data, const FitShape& shape) { return Fitting(data, shape).run(); }

}  // namespace limcycle
