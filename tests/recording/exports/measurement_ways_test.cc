#include "recording/exports/measurement_ways.h"

#include <gtest/gtest.h>

namespace ttf::recording::exports {
namespace {

using Deed = MeasurementWays::Deed;

constexpr TrueTime at_ms(std::int64_t ms) { return TrueTime{} + Duration::milliseconds(ms); }

// Two nodes write images, each with its own numbers; the third one uses them.
struct TwoFusionNodes {
  static constexpr NodeId kFirst{0}, kSecond{1}, kUser{2};
  static constexpr PduId kOfFirst{4}, kOfSecond{5};

  std::vector<MeasurementWays::Image> images;
  MeasurementWays ways{
      {[](const MeasurementWays::Way&) {}, [this](const MeasurementWays::Image& image) { images.push_back(image); }}};

  void write(NodeId node, PduId pdu, std::uint32_t number, std::int64_t ms) {
    ways.act({Deed::kImage, at_ms(ms), node, {}, number});
    ways.wrote(node, pdu);
  }
  void use(std::uint32_t number, std::int64_t ms) { ways.act({Deed::kUsed, at_ms(ms), kUser, {}, number}); }
  // The nodes whose images were used, in order of writing.
  std::vector<NodeId> used() {
    ways.advance(at_ms(100), [](const MeasurementWays::Act&, const WayMark&) {});
    ways.finish();
    std::vector<NodeId> nodes;
    for (const MeasurementWays::Image& image : images)
      if (image.used) nodes.push_back(image.node);
    return nodes;
  }
};

TEST(MeasurementWays, AnImageIsKnownByItsWriterAndItsNumber) {
  TwoFusionNodes cluster;
  cluster.write(cluster.kFirst, cluster.kOfFirst, 7, 1);
  cluster.write(cluster.kSecond, cluster.kOfSecond, 7, 2);
  cluster.ways.read(cluster.kUser, cluster.kOfFirst, 7);
  cluster.use(7, 3);
  EXPECT_EQ(cluster.used(), (std::vector<NodeId>{cluster.kFirst}));
}

// Also where another list of that number was read before.
TEST(MeasurementWays, OfEachListTheLastOneReadCounts) {
  TwoFusionNodes cluster;
  cluster.ways.read(cluster.kUser, cluster.kOfFirst, 7);
  cluster.write(cluster.kFirst, cluster.kOfFirst, 8, 1);
  cluster.write(cluster.kSecond, cluster.kOfSecond, 7, 2);
  cluster.ways.read(cluster.kUser, cluster.kOfFirst, 8);
  cluster.ways.read(cluster.kUser, cluster.kOfSecond, 7);
  cluster.use(7, 3);
  EXPECT_EQ(cluster.used(), (std::vector<NodeId>{cluster.kSecond}));
}

// Another service's list, or one that a gateway passes on, may have the image's number. Its writer does not fuse.
TEST(MeasurementWays, AListOfANodeThatDoesNotFuseIsNoImage) {
  TwoFusionNodes cluster;
  constexpr NodeId kService{3};
  constexpr PduId kWarnings{3};
  cluster.ways.wrote(kService, kWarnings);
  cluster.write(cluster.kFirst, cluster.kOfFirst, 7, 1);
  cluster.write(cluster.kSecond, cluster.kOfSecond, 7, 2);
  cluster.ways.read(cluster.kUser, kWarnings, 7);
  cluster.ways.read(cluster.kUser, cluster.kOfFirst, 7);
  cluster.use(7, 3);
  EXPECT_EQ(cluster.used(), (std::vector<NodeId>{cluster.kFirst}));
}

// A part of a log may lack the hops. For lists that a gateway passes on, the gateway is the writer.
TEST(MeasurementWays, WhereTheWriterIsNotGivenTheNumberDecides) {
  for (const bool by_gateway : {false, true}) {
    TwoFusionNodes cluster;
    cluster.write(cluster.kFirst, cluster.kOfFirst, 7, 1);
    if (by_gateway) {
      cluster.ways.wrote(NodeId{3}, PduId{6});
      cluster.ways.read(cluster.kUser, PduId{6}, 7);
    }
    cluster.use(7, 3);
    EXPECT_EQ(cluster.used(), (std::vector<NodeId>{cluster.kFirst}));
  }
}

}  // namespace
}  // namespace ttf::recording::exports
