#include "cli/live_media/bus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string_view>

#include "cli/supervision/preflight.h"
#include "core/errors.h"

namespace ttf::cli::live_media {
namespace {

using supervision::all_good;
using supervision::json_of;
using supervision::text_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Bus, IsReadAndWritten) {
  EXPECT_EQ(Bus::parse("dds").medium, &kDds);
  EXPECT_THAT(Bus::parse("dds").interfaces, IsEmpty());
  EXPECT_EQ(Bus::parse("socketcan:can0").medium, &kSocketCan);
  EXPECT_EQ(Bus::parse("dds").text(), "dds");
  EXPECT_THAT(Bus::parse("socketcan:can0").interfaces, ElementsAre("can0"));
  EXPECT_THAT(Bus::parse("socketcan:vcan0,vcan1").interfaces, ElementsAre("vcan0", "vcan1"));
  EXPECT_EQ(Bus::parse("socketcan:vcan0,vcan1").text(), "socketcan:vcan0,vcan1");
}

TEST(Bus, CarriesAChannelThatItHasAnInterfaceFor) {
  using schedules::model::Channel;
  EXPECT_TRUE(Bus::parse("dds").carries(Channel::kB));  // it has no interfaces
  EXPECT_TRUE(Bus::parse("socketcan:a").carries(Channel::kA));
  EXPECT_FALSE(Bus::parse("socketcan:a").carries(Channel::kB));
  EXPECT_TRUE(Bus::parse("socketcan:a,b").carries(Channel::kB));
}

TEST(Bus, IsExplained) {
  EXPECT_EQ(bus_help(), "dds (default), or socketcan:IF[,IF] with the interfaces of channels A and B");
  EXPECT_EQ(forms_with_interfaces(), "socketcan:IF[,IF]");
}

// For every medium in the table.
TEST(LiveMedia, EachRowIsWhole) {
  std::set<std::string_view> names;
  for (const LiveMediumRow* const medium : kLiveMedia) {
    EXPECT_TRUE(names.insert(medium->name).second) << medium->name;
    EXPECT_EQ(medium->name.find_first_of(":,"), std::string_view::npos) << medium->name;
    EXPECT_TRUE(medium->form.starts_with(medium->name)) << medium->form;
    EXPECT_FALSE(medium->expectation.empty()) << medium->name;
    EXPECT_LE(medium->least_interfaces, medium->most_interfaces) << medium->name;
    EXPECT_LE(medium->most_interfaces, 2u) << medium->name;  // one a channel
    EXPECT_TRUE(medium->look_at != nullptr && medium->make != nullptr) << medium->name;
  }
  // The first medium carries virtual time, as --virtual-time states.
  EXPECT_TRUE(kLiveMedia.front()->not_in_virtual_time.empty());
  EXPECT_FALSE(kLiveMedia.front()->has_interfaces());
}

TEST(Bus, RefusesWhatIsNone) {
  for (const char* const text :
       {"", "can", "dds:", "dds:lo", "dds,lo", "socketcan", "socketcan:", "socketcan:,", "socketcan:a,", "socketcan:,a",
        "socketcan:a,b,c", "socketcan:a,a", "socketcan:a b", "socketcan:a/b", "socketcan:..",
        "socketcan:sixteen_letters_", "socketcan:a;reboot\n"}) {
    try {
      Bus::parse(text);
      ADD_FAILURE() << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("--bus"));
      EXPECT_THAT(error.what(), HasSubstr("must be dds, or socketcan: with one or two different interfaces"));
    }
  }
}

TEST(Preflight, SaysHowAMissingBusIsMade) {
  const auto items = look_at(Bus::parse("socketcan:vcan_absent,can_absent"), {});
  ASSERT_EQ(items.size(), 3u);  // the kernel's sockets first
  EXPECT_FALSE(all_good(items));
  EXPECT_EQ(items[1].how, "is not there (channel A)");
  EXPECT_THAT(items[1].commands,
              ElementsAre("ip link add dev vcan_absent type vcan", "ip link set vcan_absent mtu 72 up"));
  EXPECT_EQ(items[2].how, "is not there; `ip -details link show type can` lists the CAN interfaces (channel B)");
  EXPECT_THAT(items[2].commands, IsEmpty());  // hardware: its driver is unknown
  EXPECT_THAT(text_of(items), HasSubstr("not ready: vcan_absent is not there (channel A); as root:\n"
                                        "    ip link add dev vcan_absent type vcan\n"));
}

TEST(Preflight, DistinguishesACanFromOtherInterfaces) {
  const auto items = look_at(Bus::parse("socketcan:lo"), {});
  EXPECT_EQ(items[1].how,
            "is not a CAN interface; `ip -details link show type can` lists the CAN interfaces (channel A)");
  EXPECT_FALSE(items[1].good);
}

// An interface with the CAN's own name is not hardware, so the commands make a virtual one.
TEST(Preflight, LooksAtPrivateCans) {
  const auto items = look_at(Bus::parse("socketcan:vcan_absent"), {{"laser_can", "laser_can", true},
                                                                   {"camera_can", "camera_can", false},
                                                                   {"radar_can", "can_absent", false},
                                                                   {"sonar_can", "vcan_none", false},
                                                                   {"other_can", "lo", true}});
  ASSERT_EQ(items.size(), 7u);  // the kernel's sockets and channel A first
  EXPECT_EQ(items[2].what, "laser_can");
  EXPECT_EQ(items[2].how, "is not there (laser_can)");
  EXPECT_THAT(items[2].commands, ElementsAre("ip link add dev laser_can type vcan", "ip link set laser_can mtu 72 up"));
  EXPECT_THAT(items[3].commands,
              ElementsAre("ip link add dev camera_can type vcan", "ip link set camera_can mtu 16 up"));
  EXPECT_EQ(items[4].how, "is not there; `ip -details link show type can` lists the CAN interfaces (radar_can)");
  EXPECT_THAT(items[4].commands, IsEmpty());
  EXPECT_THAT(items[5].commands, ElementsAre("ip link add dev vcan_none type vcan", "ip link set vcan_none mtu 16 up"));
  EXPECT_THAT(items[6].how, HasSubstr("is not a CAN interface"));
  for (std::size_t i = 2; i < items.size(); ++i) EXPECT_FALSE(items[i].good) << items[i].what;
}

TEST(Preflight, DdsNeedsLoopback) {
  const auto items = look_at(Bus{}, {});
  ASSERT_EQ(items.size(), 1u);
  EXPECT_EQ(items[0].what, "lo");
  EXPECT_EQ(items[0].good, items[0].commands.empty());
  EXPECT_EQ(json_of(items)[0]["good"], items[0].good);
}

}  // namespace
}  // namespace ttf::cli::live_media
