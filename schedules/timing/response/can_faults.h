// The distribution of a CAN message's response while faults come at random: I. Broster, A. Burns, G. Rodriguez-Navas,
// "Probabilistic analysis of CAN with faults", RTSS 2002.
//
// Faults are a Poisson process of rate lambda. R_K is the response with K faults, each of which costs 31 bits and the
// longest frame of the same or a higher priority:
//   w = B' + K (31 tau + max_hep C_k) + sum_hp ceil((w + J_k + tau) / T_k) C_k,    R_K = J + w + C
// and p_K is the probability that K faults, and no more, hit it:
//   p_K = P(K, lambda S_K) - sum_{i<K} p_i P(K - i, lambda (S_K - S_i)),   S_K = R_K - J,   P(n, x) = x^n e^-x / n!
// B' is the longest frame of the message itself and of lower priorities. With it the equation holds for every
// instance whose predecessor was in time (Davis et al. 2007, section 3.4), which the paper of 2002 did not yet have.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "schedules/timing/response/can.h"

namespace ttf::schedules::timing::response {

inline constexpr int kMostFaults = 200;  // more of them count as a miss

struct FaultyResponse {
  int faults = 0;            // K
  std::int64_t longest = 0;  // R_K
  double probability = 0.0;  // p_K
};

struct FaultyResponses {
  std::vector<FaultyResponse> in_time;  // by K, up to the last R_K within min(D, T)
  double miss_probability = 1.0;        // at most: 1 - sum p_K, to about 1e-13
};

// `faults_per_unit` is lambda: faults in one unit of time, at least 0. `longest_lower` as in can_response().
FaultyResponses responses_with_faults(std::int64_t bit, double faults_per_unit, std::span<const CanMessage> higher,
                                      const CanMessage& message, std::int64_t longest_lower);

}  // namespace ttf::schedules::timing::response
