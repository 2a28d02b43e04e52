// The JSON report is JSON whatever the report holds, and says what the report says.
#include "curvetet/report.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

namespace curvetet {
namespace {

TEST(ReportJson, IsJsonAndKeepsItsOrder) {
  const std::string text = Report{}.to_json();
  const auto json = nlohmann::ordered_json::parse(text);
  EXPECT_EQ(json.begin().key(), "schema");
  EXPECT_EQ(json["schema"], 2);
  EXPECT_TRUE(json["options"].is_null());
  EXPECT_EQ(text, Report{}.to_json());
}

TEST(ReportJson, HoldsNoInfinityAndNoBrokenText) {
  Report report;
  report.worst_dihedral = std::numeric_limits<double>::quiet_NaN();
  report.worst_place = {std::numeric_limits<double>::infinity(), 1, 2};
  report.input = "\xff\xfe.step";
  report.options_json = "{broken";
  report.solids.push_back({1, "a\"b\n", 3, -std::numeric_limits<double>::infinity(), 1});
  const auto json = nlohmann::json::parse(report.to_json());
  EXPECT_TRUE(json["quality"]["worst_dihedral"].is_null());
  EXPECT_TRUE(json["quality"]["worst_place"][0].is_null());
  EXPECT_TRUE(json["options"].is_null());
  EXPECT_TRUE(json["solids"][0]["volume"].is_null());
  EXPECT_EQ(json["solids"][0]["name"], "a\"b\n");
}

TEST(ReportJson, HashesKeepAllTheirBits) {
  Report report;
  report.mesh_hash = 0xfedcba9876543211ULL;
  report.faces.resize(1);
  report.faces[0].hash_locked = 1;
  const auto json = nlohmann::json::parse(report.to_json());
  EXPECT_EQ(json["mesh_hash"], "fedcba9876543211");
  EXPECT_EQ(json["faces"][0]["hash_locked"], "0000000000000001");
}

TEST(ReportJson, SaysWhatEachRungOfTheLadderDid) {
  Report report;
  report.faces.resize(1);
  report.faces[0].ladder.volume_points = {5, 3};
  report.recovery.ladder.outer_loop = {2, 1};
  const auto json = nlohmann::ordered_json::parse(report.to_json());
  EXPECT_EQ(json["faces"][0]["ladder"]["volume_points"]["tried"], 5);
  EXPECT_EQ(json["faces"][0]["ladder"]["volume_points"]["recovered"], 3);
  EXPECT_EQ(json["recovery"]["ladder"]["outer_loop"]["recovered"], 1);
  std::vector<std::string> rungs;
  for (const auto& [name, rung] : json["recovery"]["ladder"].items()) rungs.push_back(name);
  EXPECT_EQ(rungs, (std::vector<std::string>{"reconnect", "refine", "volume_points", "outer_loop", "fallback"}));
}

TEST(ReportJson, ErrorsSayWhatWhereAndWhatToDo) {
  Report report;
  report.errors.push_back(
      {ErrorCode::self_intersection, "faces 12 and 47 meet", {"face 12"}, Vec3{1, 2, 3}, "mend it"});
  const auto json = nlohmann::json::parse(report.to_json());
  EXPECT_EQ(json["errors"][0]["code"], "self_intersection");
  EXPECT_EQ(json["errors"][0]["where"], nlohmann::json({1.0, 2.0, 3.0}));
  EXPECT_EQ(json["errors"][0]["hint"], "mend it");
}

}  // namespace
}  // namespace curvetet
