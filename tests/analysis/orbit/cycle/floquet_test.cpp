#include "limcycle/analysis/orbit/cycle/floquet.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "limcycle/models/linear/dense.hpp"

using namespace limcycle;
using Eigen::Index;
using Eigen::MatrixXd;

namespace {

using Values = std::vector<std::complex<double>>;

std::mt19937& generator() {
  static std::mt19937 random;
  return random;
}

MatrixXd random_matrix(Index rows, Index columns) {
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(generator()); });
}

/// A basis that is not orthogonal, of condition about 10.
MatrixXd random_basis(Index n) { return MatrixXd::Identity(n, n) + 0.3 * random_matrix(n, n); }

/// Eigenvalues of the formed product, largest first.
Values of_product(const std::vector<MatrixXd>& factors) {
  MatrixXd product = factors.front();
  for (std::size_t k = 1; k < factors.size(); ++k) product = (factors[k] * product).eval();
  const Eigen::VectorXcd found = eigenvalues(product);
  Values values(found.begin(), found.end());
  std::ranges::sort(values, [](auto a, auto b) {
    return std::abs(std::abs(a) - std::abs(b)) > 1e-12 * std::abs(a) ? std::abs(a) > std::abs(b) : a.imag() > b.imag();
  });
  return values;
}

/// Factors S_(k+1) D_k S_k^-1 with S_K = S_0, so that the product has the eigenvalues of D_K-1 ... D_0.
std::vector<MatrixXd> disguised(const std::vector<MatrixXd>& blocks) {
  std::vector<MatrixXd> bases, factors;
  for (std::size_t k = 0; k < blocks.size(); ++k) bases.push_back(random_basis(blocks[k].cols()));
  for (std::size_t k = 0; k < blocks.size(); ++k)
    factors.push_back(bases[(k + 1) % blocks.size()] * blocks[k] * bases[k].inverse());
  return factors;
}

void check_largest(const Values& found, const Values& expected, double accuracy) {
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CAPTURE(i, found[i], expected[i]);
    CHECK(std::abs(found[i] - expected[i]) <= accuracy * std::abs(expected[0]));
  }
}

}  // namespace

TEST_CASE("eigenvalues of a product: those of the formed product of random factors") {
  generator().seed(1);
  for (int i = 0; i < 40; ++i) {
    const Index n = 1 + i % 6;
    std::vector<MatrixXd> factors;
    for (int k = 0; k <= i % 7; ++k) factors.push_back(random_matrix(n, n));
    check_largest(product_eigenvalues(factors), of_product(factors), 1e-9);
  }
}

TEST_CASE("eigenvalues of a product: order and determinant, with eigenvalues of like size") {
  generator().seed(2);
  std::vector<MatrixXd> factors;
  for (int k = 0; k < 12; ++k)
    factors.push_back(MatrixXd(Eigen::HouseholderQR<MatrixXd>(random_matrix(5, 5)).householderQ()));
  const auto values = product_eigenvalues(factors);  // of an orthogonal matrix: all on the unit circle
  REQUIRE(values.size() == 5);
  std::complex<double> product = 1.0;
  for (const auto& value : values) {
    CHECK(std::abs(value) == Approx(1.0).epsilon(1e-12));
    product *= value;
  }
  double determinant = 1.0;
  for (const auto& factor : factors) determinant *= factor.determinant();
  CHECK(std::abs(product - determinant) < 1e-11);
}

TEST_CASE("eigenvalues of a product: tiny ones keep their relative accuracy where the formed product loses them") {
  generator().seed(3);
  for (const double least : {1e-12, 1e-40, 1e-150}) {
    const int K = 60;
    const double middle = std::sqrt(least);
    std::vector<MatrixXd> blocks;
    for (int k = 0; k < K; ++k)
      blocks.push_back(
          Eigen::Vector3d(std::pow(0.7, 1.0 / K), std::pow(middle, 1.0 / K), std::pow(least, 1.0 / K)).asDiagonal());
    blocks.back()(1, 1) *= -1.0;
    const auto values = product_eigenvalues(disguised(blocks));
    REQUIRE(values.size() == 3);
    CHECK(values[0].real() == Approx(0.7).epsilon(1e-10));
    CHECK(values[1].real() == Approx(-middle).epsilon(1e-10));
    CHECK(values[2].real() == Approx(least).epsilon(1e-10));
    for (const auto& value : values) CHECK(value.imag() == 0.0);
  }
}

TEST_CASE("eigenvalues of a product: one factor alone contracts as strongly as the whole") {
  generator().seed(4);
  std::vector<MatrixXd> blocks(8, MatrixXd::Identity(3, 3));
  blocks[5](1, 1) = 1e-9;
  blocks[5](2, 2) = 1e-12;
  const auto values = product_eigenvalues(disguised(blocks));
  CHECK(values[0].real() == Approx(1.0).epsilon(1e-12));
  // The factor itself, formed in double, holds 1e-9 to 1e-7 and 1e-12 to 1e-4 of it at best.
  CHECK(values[1].real() == Approx(1e-9).epsilon(1e-5));
  CHECK(std::abs(values[2]) < 1e-11);
}

TEST_CASE("eigenvalues of a product: complex pairs, large and tiny") {
  generator().seed(5);
  const int K = 24;
  const double angle = 0.37, tiny = 1e-60;
  std::vector<MatrixXd> blocks;
  for (int k = 0; k < K; ++k) {
    MatrixXd block = MatrixXd::Zero(4, 4);
    block.topLeftCorner(2, 2) = std::pow(0.9, 1.0 / K) * Eigen::Rotation2Dd(angle / K).toRotationMatrix();
    block.bottomRightCorner(2, 2) = std::pow(tiny, 1.0 / K) * Eigen::Rotation2Dd(2.0 / K).toRotationMatrix();
    blocks.push_back(block);
  }
  const auto values = product_eigenvalues(disguised(blocks));
  REQUIRE(values.size() == 4);
  for (std::size_t i : {0U, 1U}) {
    const double sign = i == 0 ? 1.0 : -1.0;
    CHECK(std::abs(values[i] - std::polar(0.9, sign * angle)) < 1e-10);
    CHECK(std::abs(values[i + 2] / tiny - std::polar(1.0, sign * 2.0)) < 1e-9);
  }
}

TEST_CASE("eigenvalues of a product: what a factor annihilates is exactly zero") {
  generator().seed(6);
  for (int i = 0; i < 10; ++i) {
    std::vector<MatrixXd> factors;
    for (int k = 0; k < 6; ++k) factors.push_back(random_matrix(3, 3));
    // A saltation that enters sticking: the third state is wiped out.
    factors[static_cast<std::size_t>(i % 6)].row(2).setZero();
    const auto values = product_eigenvalues(factors);
    REQUIRE(values.size() == 3);
    CHECK(values[2] == 0.0);
    CHECK(std::abs(values[1]) > 0.0);
    check_largest(values, of_product(factors), 1e-9);
  }
  const std::vector<MatrixXd> nothing{random_matrix(3, 3), MatrixXd::Zero(3, 3), random_matrix(3, 3)};
  for (const auto& value : product_eigenvalues(nothing)) CHECK(value == 0.0);
  // Nilpotent: every factor has a direction that survives it, but their product has none.
  MatrixXd up = MatrixXd::Zero(2, 2);
  up(0, 1) = 3.0;
  for (const auto& value : product_eigenvalues({up, MatrixXd::Identity(2, 2)})) CHECK(std::abs(value) < 1e-12);
}

TEST_CASE("eigenvalues of a product: factors need not be square") {
  generator().seed(7);
  for (int i = 0; i < 10; ++i) {
    const std::vector<MatrixXd> factors{random_matrix(4, 2), random_matrix(5, 4), random_matrix(3, 5),
                                        random_matrix(2, 3)};
    check_largest(product_eigenvalues(factors), of_product(factors), 1e-10);
  }
  CHECK(product_eigenvalues({}).empty());
  CHECK(product_eigenvalues({MatrixXd(0, 0)}).empty());
  const auto scalar = product_eigenvalues({MatrixXd::Constant(1, 1, -2.0), MatrixXd::Constant(1, 1, 1e-200)});
  REQUIRE(scalar.size() == 1);
  CHECK(scalar[0].real() == Approx(-2e-200).epsilon(1e-12));
}
