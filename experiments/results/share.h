// Shares of drives in which an event happens, a collision for instance, and differences of two shares over the same
// drives. Student's interval of such a mean is too narrow, and has no width where the event never happens.
#pragma once

#include "experiments/results/statistics.h"

namespace ttf::experiments::results {

// Returns the mean of zeros and ones with Wilson's interval ("Probable inference, the law of succession, and
// statistical inference", Journal of the American Statistical Association 22, 1927). It is not even about the mean, so
// that half_width is the longer side. There is none without a sample.
Interval share_of(const Moments& events, double confidence);

// Returns the difference of two shares from paired differences, which are -1, 0 or 1, with the adjusted interval of
// Bonett and Price ("Adjusted Wald confidence interval for a difference of binomial proportions based on paired data",
// Journal of Educational and Behavioral Statistics 37, 2012): it adds one pair to either side. The quantile is
// Student's. The interval is about the adjusted difference; half_width is the longer side. There is none for fewer than
// two pairs.
Interval difference_of_shares(const Moments& differences, double confidence);

}  // namespace ttf::experiments::results
