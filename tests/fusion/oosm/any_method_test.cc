// The method chosen at run time is the method of that name.
#include <gtest/gtest.h>

#include <set>
#include <string_view>

#include "tests/fusion/oosm/any_methods.h"

namespace ttf::fusion::oosm {
namespace {

TEST(AnyMethod, NamesAndKindsAreOneToOne) {
  std::set<std::string_view> names;
  for (const NamedKind& named : kKinds) {
    names.insert(named.name);
    EXPECT_EQ(name_of(named.kind), named.name);
    EXPECT_EQ(OnLine(named.kind, Line{}).kind(), named.kind);
  }
  EXPECT_EQ(names.size(), kKinds.size());
}

TEST(AnyMethod, SaysHowExactTheChosenOneIs) {
  for (const Kind kind : {Kind::kRewind, Kind::kAugmented, Kind::kClone})
    EXPECT_EQ(OnLine(kind, Line{}).exactness(), Exactness::kAlways);
  for (const Kind kind : {Kind::kAdjoint, Kind::kA}) EXPECT_EQ(OnLine(kind, Line{}).exactness(), Exactness::kOneLate);
  for (const Kind kind : {Kind::kAl1, Kind::kBl1, Kind::kB, Kind::kC})
    EXPECT_EQ(OnLine(kind, Line{}).exactness(), Exactness::kApproximate);
}

template <class X> void expect_the_same(Kind kind) {
  RandomStream stream({.seed = 9});
  const linear::Gaussian<2> prior = drawn_prior<2>(stream);
  const auto events = delayed(stream, drawn_timeline<2, 1>(stream, 30), 3);
  X method(Line{});
  OnLine any(kind, Line{});
  method.start(GlobalTime{}, prior);
  any.start(GlobalTime{}, prior);
  EXPECT_EQ(take_all(any, events), take_all(method, events));
  EXPECT_TRUE(same_bits<2>(any.state(), method.state()));
  EXPECT_EQ(any.exactness(), X::kExactness);
}

TEST(AnyMethod, IsTheMethodItself) {
  expect_the_same<Rewind<2, 1, Line, 24>>(Kind::kRewind);
  expect_the_same<AlgorithmB<2, 1, Line>>(Kind::kB);
  expect_the_same<Bl1<2, 1, Line, 24>>(Kind::kBl1);
}

}  // namespace
}  // namespace ttf::fusion::oosm
