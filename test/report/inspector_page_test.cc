// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/inspector_page.h"

#include <filesystem>

#include "absl/strings/escaping.h"
#include "cartographer_sdf/file/sha256.h"
#include "cartographer_sdf/report/json.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/decoded_png.h"
#include "test/testing/inspected_rooms.h"
#include "test/testing/markup_reader.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::inspector_page_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

int Count(const std::string& text, const std::string& part) {
  int count = 0;
  for (size_t i = text.find(part); i != std::string::npos;
       i = text.find(part, i + 1)) {
    ++count;
  }
  return count;
}

// What lies between two texts, the first time.
std::string Between(const std::string& text, const std::string& begin,
                    const std::string& end) {
  const size_t from = text.find(begin);
  if (from == std::string::npos) return "";
  const size_t first = from + begin.size();
  return text.substr(first, text.find(end, first) - first);
}

Json DocumentOf(const std::string& html) {
  return Json::parse(Between(html, "id=\"document\">", "</script>"));
}

class InspectorPageTest : public ::testing::Test {
 protected:
  InspectorPageTest() {
    Inspection& inspection = rooms_.inspection;
    inspection.title = "evil <script>alert(\"1\")</script> & 'map'.pbstream";
    inspection.verdict = "half of <it> is missing {{style}} \xff";
    inspection.remarks = {"a <remark>"};
    inspection.numbers = {{"submaps", "97"}, {"a<b", "c&d"}};
    inspection.tables[0].rows[0].remark = "contradicts </script><!-- <others>";
    HistogramPlot histogram;
    histogram.title = "residual";
    histogram.series = {{"before", {0., 1., 2.}}, {"after", {0., 0.}}};
    inspection.histograms = {histogram};
    inspection.stage_seconds = {{"read", 1.}, {"match", 3.}};
    request_.options_text = "SDF = { name = \"</pre>\" }\n";
    request_.run.program = "cartographer_sdf";
    request_.run.version = "0.1.0";
    request_.run.command = "close_loops";
    request_.run.arguments = {"a map.pbstream", "--output=b.pbstream"};
    request_.run.inputs = {{"input", "a map.pbstream", 77, "50b5e8a3"}};
    request_.changed_options = {{"a.b", "<5>", "4"}};
  }

  testing::InspectedRooms rooms_;
  ReportRequest request_;
};

TEST_F(InspectorPageTest, IsWellFormedEscapedAndSelfContained) {
  ASSERT_TRUE(rooms_.Draw().ok());
  const std::string html = RenderInspector(request_, rooms_.inspection);
  EXPECT_EQ(MarkupError(html), "");
  EXPECT_THAT(html,
              AllOf(HasSubstr("evil &lt;script&gt;"),
                    HasSubstr("is missing {{style}} \xef\xbf\xbd"),
                    HasSubstr("a &lt;remark&gt;"), HasSubstr("&lt;/pre&gt;"),
                    HasSubstr("half of &lt;it&gt;"), HasSubstr("&lt;5&gt;")));
  // The document, and our own script.
  EXPECT_EQ(Count(html, "<script"), 2);
  EXPECT_EQ(Count(html, "</script"), 2);
  EXPECT_EQ(Count(html, "<!--"), 2);
  EXPECT_THAT(html, AllOf(Not(HasSubstr("http:")), Not(HasSubstr("https:")),
                          Not(HasSubstr("url(")), Not(HasSubstr("@import"))));
  // No placeholder is left but that of the text.
  EXPECT_EQ(Count(html, "{{"), 2);
}

TEST_F(InspectorPageTest, ItsPolicyAllowsItsScriptAlone) {
  const std::string html = RenderInspector(request_, rooms_.inspection);
  const std::string script = Between(html, "<script>", "</script>");
  ASSERT_GT(script.size(), 1000u);
  EXPECT_THAT(
      html,
      HasSubstr("script-src 'sha256-" +
                absl::Base64Escape(absl::HexStringToBytes(Sha256(script))) +
                "'\""));
  EXPECT_THAT(html, HasSubstr("default-src 'none'"));
}

TEST_F(InspectorPageTest, CarriesTheDocument) {
  ASSERT_TRUE(rooms_.Draw().ok());
  const Json document =
      DocumentOf(RenderInspector(request_, rooms_.inspection));
  EXPECT_EQ(document["schema"], "cartographer_sdf.inspection");
  EXPECT_EQ(document["title"], rooms_.inspection.title);
  EXPECT_EQ(document["tables"][0]["rows"][0]["remark"],
            rooms_.inspection.tables[0].rows[0].remark);
}

TEST_F(InspectorPageTest, ShowsTheMainThingsWithoutJavaScript) {
  ASSERT_TRUE(rooms_.Draw().ok());
  const std::string page = RenderInspector(request_, rooms_.inspection);
  const std::string html = page.substr(0, page.find("<script"));
  EXPECT_THAT(
      html,
      AllOf(HasSubstr("half of &lt;it&gt;"), HasSubstr("<td>97</td>"),
            HasSubstr("cartographer_sdf close_loops &#39;a map.pbstream&#39; "
                      "--output=b.pbstream"),
            HasSubstr("77 bytes, SHA-256 50b5e8a3"),
            HasSubstr("Before: floor plan of 15 by 5 m"),
            HasSubstr("After: floor plan of 15 by 5 m"), HasSubstr("<svg")));
  const std::string prefix = "data:image/png;base64,";
  EXPECT_EQ(Count(html, prefix), 2);
  std::string png;
  ASSERT_TRUE(absl::Base64Unescape(Between(html, prefix, "\""), &png));
  EXPECT_EQ(DecodePng(png).width, rooms_.inspection.drawn.width);
}

TEST_F(InspectorPageTest, LeavesOutWhatIsEmpty) {
  const PoseGraph nothing;
  Inspection inspection;
  inspection.title = "empty";
  inspection.sessions = {{"none"}};
  const std::string html = RenderInspector({}, inspection);
  EXPECT_EQ(MarkupError(html), "");
  EXPECT_THAT(html, AllOf(Not(HasSubstr("<img")), Not(HasSubstr("nan")),
                          HasSubstr("All options have their default values")));
  EXPECT_EQ(DocumentOf(html)["frame"], nullptr);
  EXPECT_TRUE(DocumentOf(html)["tables"].empty());
}

TEST_F(InspectorPageTest, WritesIntoANewDirectory) {
  const testing::TemporaryDirectory directory;
  request_.directory = directory.File("a/b");
  ASSERT_TRUE(WriteInspector(request_, rooms_.inspection).ok());
  ASSERT_TRUE(WriteInspector(request_, rooms_.inspection).ok());
  EXPECT_EQ(directory.Read("a/b/index.html"),
            RenderInspector(request_, rooms_.inspection));
  // Nothing temporary is left.
  int num_files = 0;
  for (const auto& unused :
       std::filesystem::directory_iterator(request_.directory)) {
    static_cast<void>(unused);
    ++num_files;
  }
  EXPECT_EQ(num_files, 1);
}

TEST_F(InspectorPageTest, SaysWhereItCannotWrite) {
  const testing::TemporaryDirectory directory;
  directory.Write("file", "");
  request_.directory = directory.File("file/x");
  const absl::Status status = WriteInspector(request_, rooms_.inspection);
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(std::string(status.message()), HasSubstr(request_.directory));
}

}  // namespace
}  // namespace cartographer_sdf::inspector_page_test
