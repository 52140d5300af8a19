// RODAS5P's coefficients, checked as algebra: order conditions of the method, of its embedded solution and of its
// interpolant, and the stability function.
#include "limcycle/analysis/motion/steppers/rodas5p_tableau.hpp"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <complex>
#include <cstddef>
#include <vector>

namespace {

namespace tableau = limcycle::rodas5p;
constexpr auto n = static_cast<Eigen::Index>(tableau::stages);
using Matrix = Eigen::Matrix<double, n, n>;
using Vector = Eigen::Matrix<double, n, 1>;

Matrix matrix(const std::array<tableau::Row, tableau::stages>& rows) {
  Matrix m;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j) m(i, j) = rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  return m;
}

Vector vector(const tableau::Row& row) { return Eigen::Map<const Vector>(row.data()); }

/// The method in the form of Hairer & Wanner, Solving ODEs II, (IV.7.4). The table holds u = Gamma k instead of k:
/// A = alpha Gamma^-1, C = diag(1/gamma) - Gamma^-1, weights m = b Gamma^-1.
struct Classical {
  Matrix gamma = (Matrix::Identity() / tableau::gamma - matrix(tableau::C)).inverse();
  Matrix alpha = matrix(tableau::A) * gamma;
  Matrix beta = alpha + gamma;
  /// Weights of the embedded solution: the argument of the last stage; the solution adds the last stage.
  Vector embedded = alpha.row(n - 1);
  Vector b = embedded + gamma.row(n - 1).transpose();

  /// Weights of the interpolant at theta.
  Vector dense(double theta) const {
    Vector row = Vector::Zero();
    for (std::size_t q = 3; q-- > 0;) row = vector(tableau::H[q]) + theta * row;
    return theta * b + theta * (1 - theta) * gamma.transpose() * row;
  }
};

/// Rooted tree: the elementary differentials of f, one order condition each.
struct Tree {
  std::vector<Tree> branches;

  int order() const {
    int nodes = 1;
    for (const Tree& branch : branches) nodes += branch.order();
    return nodes;
  }
  double density() const {
    double product = order();
    for (const Tree& branch : branches) product *= branch.density();
    return product;
  }
  /// Stage values: a node with one branch is reached through f and J together (beta), one with more through f only.
  Vector stage_weights(const Classical& method) const {
    Vector product = Vector::Ones();
    const Matrix& inner = branches.size() == 1 ? method.beta : method.alpha;
    for (const Tree& branch : branches) product = product.cwiseProduct(inner * branch.stage_weights(method));
    return product;
  }
};

/// Adds to `found` the trees whose root has the branches given and others, taken from known[0..last], of `nodes` nodes.
void grow(const std::vector<Tree>& known, std::size_t last, int nodes, std::vector<Tree>& branches,
          std::vector<Tree>& found) {
  if (nodes == 0) {
    found.push_back({branches});
    return;
  }
  for (std::size_t i = 0; i < last && i < known.size(); ++i) {
    if (known[i].order() > nodes) continue;
    branches.push_back(known[i]);
    grow(known, i + 1, nodes - known[i].order(), branches, found);
    branches.pop_back();
  }
}

std::vector<Tree> trees_up_to(int order) {
  std::vector<Tree> trees;
  for (int nodes = 1; nodes <= order; ++nodes) {
    std::vector<Tree> found;
    std::vector<Tree> branches;
    grow(trees, trees.size(), nodes - 1, branches, found);
    trees.insert(trees.end(), found.begin(), found.end());
  }
  return trees;
}

double defect(const Tree& tree, const Classical& method, const Vector& weights, double theta = 1) {
  return weights.dot(tree.stage_weights(method)) - std::pow(theta, tree.order()) / tree.density();
}

/// Stability function R(z) = 1 + z b^T (I - z beta)^-1 1 of x' = lambda x, z = lambda h.
double growth(const Classical& method, const Vector& weights, std::complex<double> z) {
  using Complex = Eigen::Matrix<std::complex<double>, n, n>;
  const Complex system = Complex::Identity() - z * method.beta.cast<std::complex<double>>();
  const Eigen::Matrix<std::complex<double>, n, 1> k =
      system.partialPivLu().solve(Vector::Ones().cast<std::complex<double>>());
  return std::abs(1.0 + z * (weights.cast<std::complex<double>>().transpose() * k).value());
}

}  // namespace

TEST_CASE("RODAS5P meets the 17 order conditions up to order 5", "[rodas5p]") {
  const Classical method;
  const std::vector<Tree> trees = trees_up_to(5);
  REQUIRE(trees.size() == 17);
  for (const Tree& tree : trees) {
    CAPTURE(tree.order(), tree.density());
    CHECK(std::abs(defect(tree, method, method.b)) < 1e-12);
  }
}

TEST_CASE("RODAS5P is not of order 6", "[rodas5p]") {
  // Guards the test above: a check that any table passes would pass here too.
  const Classical method;
  double worst = 0;
  for (const Tree& tree : trees_up_to(6))
    if (tree.order() == 6) worst = std::max(worst, std::abs(defect(tree, method, method.b)));
  CHECK(worst > 1e-6);
}

TEST_CASE("RODAS5P's embedded solution is of order 4, not 5", "[rodas5p]") {
  const Classical method;
  double worst_of_order_5 = 0;
  for (const Tree& tree : trees_up_to(5)) {
    CAPTURE(tree.order(), tree.density());
    const double d = std::abs(defect(tree, method, method.embedded));
    if (tree.order() <= 4) {
      CHECK(d < 1e-12);
    } else {
      worst_of_order_5 = std::max(worst_of_order_5, d);
    }
  }
  CHECK(worst_of_order_5 > 1e-6);
}

TEST_CASE("RODAS5P's interpolant is of order 4 everywhere in the step", "[rodas5p]") {
  const Classical method;
  for (const double theta : {0.05, 0.3, 0.5, 0.77, 0.95})
    for (const Tree& tree : trees_up_to(4)) {
      CAPTURE(theta, tree.order(), tree.density());
      CHECK(std::abs(defect(tree, method, method.dense(theta), theta)) < 1e-11);
    }
}

TEST_CASE("RODAS5P's nodes and time weights are the row sums of alpha and Gamma", "[rodas5p]") {
  const Classical method;
  CHECK((method.alpha * Vector::Ones() - vector(tableau::node)).cwiseAbs().maxCoeff() < 1e-12);
  CHECK((method.gamma * Vector::Ones() - vector(tableau::time_weight)).cwiseAbs().maxCoeff() < 1e-12);
}

TEST_CASE("RODAS5P is stiffly accurate and L-stable", "[rodas5p]") {
  const Classical method;
  // Stiffly accurate: the weights are the last row of beta, and the last stage is at the end of the step.
  CHECK((method.b.transpose() - method.beta.row(n - 1)).cwiseAbs().maxCoeff() < 1e-12);
  CHECK(tableau::node.back() == 1);
  // R at infinity is 1 - b^T beta^-1 1.
  CHECK(std::abs(1 - method.b.dot(method.beta.partialPivLu().solve(Vector::Ones()))) < 1e-11);
  CHECK(std::abs(1 - method.embedded.dot(method.beta.partialPivLu().solve(Vector::Ones()))) < 1e-11);
  // The poles are at 1/gamma > 0, so |R| <= 1 on the imaginary axis makes it so on the left half plane.
  for (double exponent = -2; exponent <= 6; exponent += 0.01) {
    const double y = std::pow(10.0, exponent);
    CAPTURE(y);
    CHECK(growth(method, method.b, {0, y}) <= 1 + 1e-12);
  }
}
