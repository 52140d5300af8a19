#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

namespace limcycle {

/// Eigenvalues of the product F_K ... F_2 F_1 without ever forming it, largest modulus first, as accurate,
/// relatively, as the factors are, however small it is: orthogonal iteration through the factors (F_k Q_k-1 = Q_k R_k,
/// over and over until Q returns to itself) until the periodic Schur form separates the moduli; what is not separated
/// by then is of like size and is solved as a small block (Bojanczyk, Golub and Van Dooren, 1992; Dieci and Van Vleck,
/// 1995). Exact zeros (sticking) come out as zeros; moduli below 1e-308 as zeros too. F_1 has as many columns as F_K
/// has rows. Cost: about 30 QR decompositions a factor.
std::vector<std::complex<double>> product_eigenvalues(const std::vector<Eigen::MatrixXd>& factors);

}  // namespace limcycle
