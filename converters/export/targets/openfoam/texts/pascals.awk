# Turns the samples of OpenFOAM, in ASCII, into pressure and wall shear stress in Pa, and lengths into mm.
/<DataArray/ {
  factor = 0
  if (/Name=.p./) { factor = {density}; sub(/Name=.p./, "Name=\"pressure_Pa\"") }
  if (/Name=.wallShearStress./) { factor = -{density}; sub(/Name=.wallShearStress./, "Name=\"wall_shear_stress_Pa\"") }
  if (/Name=.Points./) factor = 1000
  print
  next
}
/</ { factor = 0; print; next }
factor == 0 { print; next }
{ for (i = 1; i <= NF; ++i) printf "%s%.7g", i == 1 ? "" : " ", factor * $i; print "" }
