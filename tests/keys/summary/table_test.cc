// A table writes what it describes.
#include "keys/summary/table.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ttf::keys::summary {
namespace {

struct Wheel {
  std::string name;
  std::optional<double> slip;
};
struct Car {
  int doors = 4;
  std::vector<Wheel> wheels;
  std::vector<std::pair<std::string, double>> loads;
  std::optional<Wheel> spare;
};

const Rows<Wheel> kWheel{
    {"name", [](auto& wheel) { return wheel.name; }, "its place"},
    {"slip", [](auto& wheel) { return wheel.slip; }, "its slip"},
};
const Rows<Car> kCar{
    {"doors", [](auto& car) { return car.doors; }, "number of doors"},
    {"wheels", [](auto& car) { return car.wheels; }, "its wheels", kWheel},
    {"loads", [](auto& car) { return car.loads; }, "loads by axle", "a load", Absent::kIfEmpty},
    {"spare", [](auto& car) { return car.spare; }, "a spare wheel", kWheel, Absent::kIfNull},
    {"",
     [](auto&) {
       return Wheel{"steering", 0.5};
     },
     "the steering wheel", kWheel},
};

TEST(Table, WritesNullsAndLeavesMembersOut) {
  EXPECT_EQ(json_of(kCar, Car{}).dump(), R"({"doors":4,"wheels":[],"name":"steering","slip":0.5})");
  EXPECT_EQ(json_of(kCar, Car{2, {{"left", {}}}, {{"rear", 7.0}}, Wheel{"spare", {}}}).dump(),
            R"({"doors":2,"wheels":[{"name":"left","slip":null}],"loads":{"rear":7.0},)"
            R"("spare":{"name":"spare","slip":null},"name":"steering","slip":0.5})");
}

TEST(Table, DescribesWhatItWrites) {
  std::string text;
  for (const Member& member : described(kCar, "car"))
    text += member.path + ": " + member.type + (member.optional ? ", optional\n" : "\n");
  EXPECT_EQ(text,
            "car.doors: integer\ncar.wheels: array\ncar.wheels[].name: string\ncar.wheels[].slip: number or null\n"
            "car.loads: object, optional\ncar.loads.NAME: number\n"
            "car.spare: object, optional\ncar.spare.name: string\ncar.spare.slip: number or null\n"
            "car: object\ncar.name: string\ncar.slip: number or null\n");
}

}  // namespace
}  // namespace ttf::keys::summary
