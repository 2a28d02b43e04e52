#include <gtest/gtest.h>

#include "geometry/describe.h"
#include "support/bodies.h"

namespace curvetet {
namespace {

TEST(Describe, SaysWhatIsThere) {
  Model model = test::make_boxes({1, 2}, 1, 1);
  model.faces[FaceId(0)].label.name = "the \"inlet\"\n";
  model.healing.push_back({"file", "lengths converted from inch to mm"});
  model.file_unit = "inch";
  model.edges[EdgeId(2)].label.name = "rim";
  const auto words = describe_model(model, false);
  ASSERT_TRUE(words);
  EXPECT_NE(words.value().find("2 solids, 11 faces"), std::string::npos) << words.value();
  EXPECT_NE(words.value().find("11 plane"), std::string::npos);
  EXPECT_NE(words.value().find("in the file in inch"), std::string::npos);
  EXPECT_NE(words.value().find("edge 3  line  rim  on faces "), std::string::npos) << words.value();
  const auto json = describe_model(model, true);
  ASSERT_TRUE(json);
  EXPECT_NE(json.value().find(R"("name": "the \"inlet\"\u000a")"), std::string::npos) << json.value();
  EXPECT_NE(json.value().find(R"("volume": 2,)"), std::string::npos) << json.value();
  EXPECT_NE(json.value().find("inch to mm"), std::string::npos);
  EXPECT_NE(json.value().find(R"("file_unit": "inch")"), std::string::npos);
  EXPECT_NE(json.value().find(R"("id": 3, "kind": "line", "name": "rim", "colour": null, "faces": [)"),
            std::string::npos);
}

}  // namespace
}  // namespace curvetet
