#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

namespace limcycle {

/// Eigenvalues of the product F_K ... F_2 F_1 without forming it, largest modulus first, with the relative accuracy of
/// the factors, however small they are. Orthogonal iteration through the factors (F_k Q_k-1 = Q_k R_k, repeated until Q
/// returns to itself) until the periodic Schur form separates the moduli; those not separated by then are of similar
/// size and are solved as a small block (Bojanczyk, Golub and Van Dooren, 1992; Dieci and Van Vleck, 1995). Exact zeros
/// (sticking) and moduli below 1e-308 come out as zeros. F_1 has as many columns as F_K has rows. Cost: about 30 QR
/// decompositions a factor.
std::vector<std::complex<double>> product_eigenvalues(const std::vector<Eigen::MatrixXd>& factors);

}  // namespace limcycle
