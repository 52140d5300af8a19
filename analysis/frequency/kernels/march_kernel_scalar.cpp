#include "limcycle/analysis/frequency/kernels/march_kernel_body.hpp"

namespace limcycle {

constinit const MarchKernels scalar_march_kernels = march_kernels<Pack<2, Isa::scalar>>();

}  // namespace limcycle
