# small_sweep REPLICATIONS DURATION FROM: a sweep of two points and two paradigms for the tests of sweeps; to
# be sourced with $source set. It drives for DURATION and is judged from FROM on.
small_sweep() {
  cat <<END
kind: sweep
name: small
question: Is it so?
scenario: $source/scenarios/dynamics.yaml
seed: 3
replications: $1
paradigms:
  adva: {strategy: adva, set: {duration: $2, evaluate_from: $3}}
  tt: {strategy: tt, set: {duration: $2, evaluate_from: $3}}
axes:
  noise: {keys: [world.acceleration_noise], values: [1, 40]}
measures: [position_rmse_truth, age_fused]
END
}
