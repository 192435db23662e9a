// A kernel CAN for tests: skipped, with the reason, where there is none.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "bus/socketcan/interface.h"

namespace ttf::bus::socketcan {

// Runs a command as one would type it; whether it succeeded.
inline bool run(const std::string& command) { return std::system((command + " >/dev/null 2>&1").c_str()) == 0; }

// Everything behind the last ": " of a problem: the command that helps.
inline std::string command_in(const std::string& problem) { return problem.substr(problem.rfind(": ") + 2); }

// Runs only where vcan0 carries CAN FD, as in docs/media/socketcan.md.
class OnVcan : public ::testing::Test {
 protected:
  static constexpr const char* kName = "vcan0";
  void SetUp() override {
    if (const std::string problem = interface_problem(kName, interface_state(kName), true); !problem.empty())
      GTEST_SKIP() << kName << ": " << problem;
  }
};

// Interfaces of the test's own, up for CAN FD; they go with it.
class Vcans {
 public:
  explicit Vcans(std::vector<std::string> names) : names_(std::move(names)) {
    for (const std::string& name : names_) {
      if (missing_.empty()) missing_ = make(name);
    }
  }
  ~Vcans() {
    for (const std::string& name : made_) run("ip link del dev " + name);
  }
  Vcans(const Vcans&) = delete;
  Vcans& operator=(const Vcans&) = delete;

  const std::string& operator[](std::size_t i) const { return names_[i]; }
  // The reason for their absence; empty: they are there.
  const std::string& missing() const { return missing_; }

 private:
  std::string make(const std::string& name) {
    if (const Problem kernel = kernel_problem(interface_state(name))) return "the kernel " + kernel.text();
    if (geteuid() != 0) return "only root makes interfaces";
    run("ip link del dev " + name);
    if (!run("ip link add dev " + name + " type vcan && ip link set " + name + " mtu 72 up"))
      return "no vcan can be made here";
    made_.push_back(name);
    return "";
  }

  std::vector<std::string> names_, made_;
  std::string missing_;
};

// An interface of the test's own, free to change. Needs a kernel with vcan, and CAP_NET_ADMIN.
class OwnVcan : public ::testing::Test {
 protected:
  static constexpr const char* kName = "vcan97";
  void SetUp() override {
    const InterfaceState state = interface_state(kName);
    if (state.refused != 0) GTEST_SKIP() << interface_problem(kName, state, true);
    if (geteuid() != 0) GTEST_SKIP() << "only root makes interfaces";
    run(std::string("ip link del dev ") + kName);
    if (!run(std::string("ip link add dev ") + kName + " type vcan")) GTEST_SKIP() << "no vcan can be made here";
  }
  void TearDown() override { run(std::string("ip link del dev ") + kName); }
  static void ip(const std::string& what) {
    ASSERT_TRUE(run(std::string("ip link set dev ") + kName + " " + what)) << what;
  }
};

}  // namespace ttf::bus::socketcan
