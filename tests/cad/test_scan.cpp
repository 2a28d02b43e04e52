// What is found in the text of a file before a reader sees it.
#include <gtest/gtest.h>

#include <fstream>

#include "cad/scan.h"
#include "shapes.h"

namespace curvetet {
namespace {

std::optional<Error> scan(const std::string& text) {
  const test::Folder folder;
  std::ofstream(folder.file("a.step")) << text;
  return scan_step(folder.file("a.step"));
}

TEST(Scan, NumbersThatAreNone) {
  for (const char* bad :
       {"nan", "NaN", "-nan", "inf", "-Infinity", "1.#QNAN", "1.E+101", "-3e308", "1e99999999999999"}) {
    const auto error =
        scan(std::string("DATA;\n#7=X('',(1.,2.));\n#12 = CARTESIAN_POINT ( '' , ( 0., ") + bad + ", 1.));\n");
    ASSERT_TRUE(error) << bad;
    EXPECT_EQ(error->code, ErrorCode::not_finite);
    EXPECT_EQ(error->entities, std::vector<std::string>{"#12"});
    EXPECT_NE(error->message.find(bad), std::string::npos);
  }
}

TEST(Scan, WhatIsLegalPasses) {
  for (const char* good :
       {"1.E+100", "-2.5e-300", "'nan'", "'it''s 1e999,nan)'", ".INF.", "$", "*", "LENGTH_MEASURE(1.)", "#1",
        "/* nan, 1e308 */ 1.", "\"0ABE999\"", "INFINITE_THING(2.)", "()"}) {
    const auto error = scan(std::string("HEADER;\nFILE_NAME('nan');\n#12=X('',(0.,") + good + ",1.));\n");
    EXPECT_FALSE(error) << good << ": " << error->message;
  }
}

TEST(Scan, BrepEnds) {
  EXPECT_TRUE(brep_is_complete("So\n\n1100000\n+2 0 *\n\n+1 0 "));
  EXPECT_TRUE(brep_is_complete("+2 0 \n*\n\n-12 3 \n0\n\n"));
  EXPECT_FALSE(brep_is_complete("So\n\n1100000\n+2 0 *\n\n"));
  EXPECT_FALSE(brep_is_complete("So\n\n1100000\n+2 0 *\n\n+1"));
  EXPECT_FALSE(brep_is_complete("+2 0 *\n\nSo\n\n1100000\n+2 0"));
  EXPECT_FALSE(brep_is_complete(""));
}

}  // namespace
}  // namespace curvetet
