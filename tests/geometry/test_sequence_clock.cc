#include <firn/core/error.h>
#include <firn/geometry/sequence_clock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace firn {
namespace {

const std::vector<double> kTimes = {1, 1.5, 3, 4};
const std::vector<double> kValues = {2, -1, 0.5, 2};

struct Track {
  double value = 0, rate = 0, weights = 0, rates = 0;
};

Track track(const SequenceClock& clock, double t) {
  Track track;
  for (const SequenceClock::Term& term : clock.at(t)) {
    track.value += term.weight * kValues[term.entry];
    track.rate += term.rate * kValues[term.entry];
    track.weights += term.weight;
    track.rates += term.rate;
  }
  return track;
}

TEST(SequenceClock, PassesThroughItsEntriesAndRatesAreDerivatives) {
  for (const AtEnd at_end : {AtEnd::hold, AtEnd::cycle}) {
    for (const Interpolation interpolation : {Interpolation::linear, Interpolation::smooth}) {
      const SequenceClock clock(kTimes, interpolation, at_end);
      for (std::size_t k = 0; k < kTimes.size(); ++k) EXPECT_NEAR(track(clock, kTimes[k]).value, kValues[k], 1e-15);
      for (double t = 1.013; t < 4; t += 0.0371) {
        const double h = 1e-6;
        const Track at = track(clock, t);
        EXPECT_NEAR(at.rate, (track(clock, t + h).value - track(clock, t - h).value) / (2 * h), 1e-7);
        EXPECT_NEAR(at.weights, 1, 1e-15);
        EXPECT_NEAR(at.rates, 0, 1e-14);
      }
    }
  }
}

TEST(SequenceClock, LinearIsStraightBetweenEntries) {
  const SequenceClock clock(kTimes, Interpolation::linear, AtEnd::hold);
  EXPECT_NEAR(track(clock, 2.5).value, -1 + 1.5 * (1 / 1.5), 1e-15);
  EXPECT_NEAR(track(clock, 2.5).rate, 1, 1e-15);
}

TEST(SequenceClock, HoldsBeforeAndAfter) {
  for (const double t : {-5.0, 0.999, 4.0, 4.001, 100.0}) {
    const SequenceClock clock(kTimes, Interpolation::smooth, AtEnd::hold);
    EXPECT_EQ(track(clock, t).value, 2);
    EXPECT_EQ(track(clock, t).rate, 0);
  }
}

TEST(SequenceClock, ACycleBeginsAgainAndKeepsItsRateWhereItIsSmooth) {
  const SequenceClock straight(kTimes, Interpolation::linear, AtEnd::cycle);
  for (const double t : {1.2, 2.9, 3.5}) {
    EXPECT_NEAR(track(straight, t + 3 * 7).value, track(straight, t).value, 1e-13);
    EXPECT_NEAR(track(straight, t + 3 * 7).rate, track(straight, t).rate, 1e-13);
  }
  const SequenceClock smooth(kTimes, Interpolation::smooth, AtEnd::cycle);
  const Track before = track(smooth, 4 - 1e-9), after = track(smooth, 4 + 1e-9);
  EXPECT_NEAR(before.rate, after.rate, 1e-6);
  EXPECT_GT(std::abs(before.rate), 0.1);
  // Held at its end, it is at rest there.
  EXPECT_NEAR(track(SequenceClock(kTimes, Interpolation::smooth, AtEnd::hold), 4 - 1e-9).rate, 0, 1e-6);
}

TEST(SequenceClock, AdvancesThroughACycleWhoseEndsDiffer) {
  // A belt: the last entry has the form of the first, with each vertex one link further on.
  const SequenceClock clock({0, 1, 2}, Interpolation::smooth, AtEnd::cycle);
  for (double t = 0.05; t < 5; t += 0.1) {
    double rate = 0;
    for (const SequenceClock::Term& term : clock.at(t)) rate += term.rate * static_cast<double>(term.entry);
    EXPECT_NEAR(rate, 1, 1e-13) << t;
  }
}

TEST(SequenceClock, SaysWhatIsWrong) {
  const auto message = [](std::vector<double> times) -> std::string {
    try {
      SequenceClock(std::move(times), Interpolation::linear, AtEnd::hold);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(message({}), "a sequence needs at least one entry");
  EXPECT_EQ(message({0, 1, 1}), "times of a sequence must be finite and increase, got 1 s after 1 s");
  EXPECT_EQ(message({0, std::numeric_limits<double>::infinity()}),
            "times of a sequence must be finite and increase, got inf s after 0 s");
}

}  // namespace
}  // namespace firn
