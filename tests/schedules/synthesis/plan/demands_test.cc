#include "schedules/synthesis/plan/demands.h"

#include "tests/schedules/synthesis/plans.h"

namespace ttf::schedules::synthesis::plan {
namespace {

std::string with_sections(const std::string& objectives, const std::string& sections) {
  return changed(plan_text("paper"), "objective: \\[[^\\]]*\\]", "objective: [" + objectives + "]\n" + sections);
}

TEST(PlanDemands, AreRead) {
  const Plan plan = parse_plan(
      with_sections("error, gap_error",
                    "  error: {process_noises: [0.01, 1, 25], motion: random_walk, over: time, sigma: {laser: 0.06, "
                    "camera: 0.15}}\n"
                    "  gap_error: {time_gap: 1500 ms, delay: 30 ms}"),
      "plan.yaml");
  EXPECT_EQ(plan.objective, (std::vector<Goal>{Goal::kError, Goal::kGapError}));
  ASSERT_TRUE(plan.error);
  EXPECT_TRUE(plan.error->random_walk && plan.error->over_time);
  EXPECT_EQ(plan.error->process_noises, (std::vector<double>{0.01, 1.0, 25.0}));
  EXPECT_EQ(plan.error->sigmas_m, (std::vector<std::optional<double>>{0.06, 0.15}));
  EXPECT_EQ(plan.gap_error.time_gap_s, 1.5);
  EXPECT_EQ(plan.gap_error.delay, Duration::milliseconds(30));
  EXPECT_EQ(plan.gap_error.lag_s, 0.2);  // as it is
}

// A copy of a sensor has its sigma, unless it is of another kind.
TEST(PlanDemands, ACopyHasTheSigmaOfItsOriginal) {
  const std::string error = "  error: {process_noise: 1, sigma: {laser: 0.06, camera: 0.15}}\n";
  const Plan plan = parse_plan(with_sections("error", error + "  sensors: {rear_laser: {like: laser}}"), "plan.yaml");
  EXPECT_EQ(plan.error->sigmas_m, (std::vector<std::optional<double>>{0.06, 0.15, 0.06}));
  const auto findings = plan_findings(with_sections(
      "error", error + "  sensors: {radar: {like: laser, kind: radar, raw: 32, objects: 12, preprocessing: 14 ms}}"));
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NE(findings[0].sentence().find("plan.error.sigma.radar"), std::string::npos);
}

struct WrongDemand {
  const char *sections, *key, *words;
};

TEST(PlanDemands, NamesEachMistake) {
  const WrongDemand mistakes[] = {
      {"", "plan.error", "must have process_noise and sigma"},
      {"  error: {process_noise: 1}", "plan.error.sigma", "is missing"},
      {"  error: {process_noise: 1, sigma: {laser: 1}}", "plan.error.sigma.camera", "begins the chain camera"},
      {"  error: {process_noise: 0, sigma: {laser: 1, camera: 1}}", "plan.error.process_noise", "must be"},
      {"  error: {sigma: {laser: 1, camera: 1}}", "plan.error.process_noise", "is missing"},
      {"  error: {process_noises: [1, much], sigma: {laser: 1, camera: 1}}", "plan.error.process_noises", "not much"},
      {"  error: {process_noises: [1, -1], sigma: {laser: 1, camera: 1}}", "plan.error.process_noises", "not -1"},
      {"  error: {process_noises: [1], process_noise: 1, sigma: {laser: 1, camera: 1}}", "plan.error.process_noise",
       "must be left out"},
      {"  error: {process_noise: 1, sigma: {laser: 0, camera: 1}}", "plan.error.sigma.laser", "must be"},
      {"  error: {process_noise: 1, sigma: {laser: 1, camera: 1, lidar: 1}}", "plan.error.sigma.lidar",
       "is not a known key"},
      {"  error: {process_noise: 1, motion: circles, sigma: {laser: 1, camera: 1}}", "plan.error.motion",
       "must be one of"},
      {"  error: {process_noise: 1, sigma: {laser: 1, camera: 1}}\n  gap_error: {lag: 0 ms}", "plan.gap_error.lag",
       "must be"},
      {"  error: {process_noise: 1, sigma: {laser: 1, camera: 1}}\n  gap_error: {gap: 2}", "plan.gap_error.gap",
       "is not a known key"},
  };
  for (const WrongDemand& mistake : mistakes) {
    const auto findings = plan_findings(with_sections("error", mistake.sections));
    ASSERT_FALSE(findings.empty()) << mistake.sections;
    const std::string sentence = findings[0].sentence();
    EXPECT_NE(sentence.find(mistake.key), std::string::npos) << sentence;
    EXPECT_NE(sentence.find(mistake.words), std::string::npos) << sentence;
    EXPECT_GT(findings[0].line, 0) << sentence;
  }
}

}  // namespace
}  // namespace ttf::schedules::synthesis::plan
