! The hunting servo of cases/pid-lugre.toml for AUTO-07p: U = (I, x, v, f), f = sigma0 z. |v| is smoothed as
! sqrt(v^2 + eps^2) with eps = 1e-9 m/s, far below what shows in the period. PAR(1) = kd, PAR(11) = period.
SUBROUTINE FUNC(NDIM, U, ICP, PAR, IJAC, F, DFDU, DFDP)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM, ICP(*), IJAC
  DOUBLE PRECISION, INTENT(IN) :: U(NDIM), PAR(*)
  DOUBLE PRECISION, INTENT(OUT) :: F(NDIM)
  DOUBLE PRECISION, INTENT(INOUT) :: DFDU(NDIM, NDIM), DFDP(NDIM, *)
  DOUBLE PRECISION, PARAMETER :: kp = 3D0, ki = 4D0, Fs = 1.5D0, Fc = 1D0, vs = 1D-3
  DOUBLE PRECISION, PARAMETER :: sigma0 = 1D5, sigma1 = 316.22776601683796D0, sigma2 = 0.4D0, eps = 1D-9
  DOUBLE PRECISION :: w, v, speed, bump, level, zrate, force, zrate_v, zrate_f

  v = U(3)
  w = v/vs
  speed = SQRT(v*v + eps*eps)
  bump = (Fs - Fc)*EXP(-w*w)
  level = Fc + bump
  zrate = v - speed*U(4)/level
  force = ki*U(1) - kp*U(2) - PAR(1)*v - (U(4) + sigma1*zrate + sigma2*v)
  F(1) = -U(2)
  F(2) = v
  F(3) = force
  F(4) = sigma0*zrate

  IF (IJAC == 0) RETURN
  zrate_v = 1 - v/speed*U(4)/level - speed*U(4)*2*w*bump/(vs*level**2)
  zrate_f = -speed/level
  DFDU = 0
  DFDU(1, 2) = -1
  DFDU(2, 3) = 1
  DFDU(3, 1) = ki
  DFDU(3, 2) = -kp
  DFDU(3, 3) = -PAR(1) - sigma1*zrate_v - sigma2
  DFDU(3, 4) = -1 - sigma1*zrate_f
  DFDU(4, 3) = sigma0*zrate_v
  DFDU(4, 4) = sigma0*zrate_f

  IF (IJAC == 1) RETURN
  DFDP(:, 1) = 0
  DFDP(3, 1) = -v
END SUBROUTINE FUNC

SUBROUTINE STPNT(NDIM, U, PAR, T)
  IMPLICIT NONE
  INTEGER, INTENT(IN) :: NDIM
  DOUBLE PRECISION, INTENT(INOUT) :: U(NDIM), PAR(*)
  DOUBLE PRECISION, INTENT(IN) :: T
  PAR(1) = 6D0
END SUBROUTINE STPNT
