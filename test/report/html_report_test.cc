// SPDX-FileCopyrightText: 2026 The cartographer_sdf authors
// SPDX-License-Identifier: Apache-2.0

#include "cartographer_sdf/report/html_report.h"

#include "absl/strings/escaping.h"
#include "cartographer_sdf/report/picture.h"
#include "gmock/gmock.h"
#include "gtest/gtest.h"
#include "test/testing/decoded_png.h"
#include "test/testing/markup_reader.h"
#include "test/testing/temporary_directory.h"

namespace cartographer_sdf::html_report_test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string SmallPng() { return Picture(3, 2, Color{1., 0., 0.}).EncodePng(); }

int Count(const std::string& text, const std::string& part) {
  int count = 0;
  for (size_t i = text.find(part); i != std::string::npos;
       i = text.find(part, i + 1)) {
    ++count;
  }
  return count;
}

ReportedClosure TestClosure(const int index) {
  ReportedClosure reported;
  reported.match.pair = {
      {0, index}, {1, index + 10}, Rigid2(1.25, -2.5, M_PI / 2.), 4.5};
  reported.match.inliers.resize(17);
  PairEvidence& evidence = reported.match.evidence;
  evidence.overlap_area = 321.5;
  evidence.overlap = 0.625;
  // The worse direction is reported; root mean square distance of all hits.
  evidence.query_in_reference = {64., 56., 1., 60. * 0.0625 * 0.0625};
  evidence.reference_in_query = {64., 64., 0.5, 60. * 0.0625 * 0.0625};
  reported.accepted = index % 2 == 0;
  if (!reported.accepted) reported.reason = "contradicts <others>";
  reported.png = SmallPng();
  return reported;
}

ReportContent TestContent() {
  ReportContent content;
  content.title = "evil <script>alert(\"1\")</script> & 'map'.pbstream";
  content.subtitle = "cartographer_sdf 0.1.0 \xff";
  content.summary = {{"submaps", "97"}, {"a<b", "c&d"}};
  content.warnings = {"half of <it> is missing"};
  content.maps = {{"before", SmallPng()}, {"after", SmallPng()}};
  for (int i = 0; i < 6; ++i) content.closures.push_back(TestClosure(i));
  HistogramPlot histogram;
  histogram.title = "residual";
  histogram.series = {{"before", {0., 1., 2.}}, {"after", {0., 0.}}};
  content.histograms = {histogram};
  content.stages = {{"read", 1.}, {"match", 3.}};
  content.options = "SDF = { name = \"</pre>\" }\n";
  return content;
}

TEST(HtmlReportTest, IsWellFormedEscapedAndSelfContained) {
  const std::string html = RenderReport(TestContent());
  EXPECT_EQ(MarkupError(html), "");
  EXPECT_THAT(
      html, AllOf(HasSubstr("evil &lt;script&gt;"), Not(HasSubstr("<script")),
                  HasSubstr("0.1.0 \xef\xbf\xbd"),
                  HasSubstr("contradicts &lt;others&gt;"),
                  HasSubstr("&lt;/pre&gt;"), HasSubstr("half of &lt;it&gt;")));
  EXPECT_THAT(html, AllOf(Not(HasSubstr("http:")), Not(HasSubstr("https:")),
                          Not(HasSubstr("url(")), Not(HasSubstr("@import"))));
}

TEST(HtmlReportTest, ShowsTheEvidence) {
  ReportContent content;
  content.closures = {TestClosure(2)};
  const std::string html = RenderReport(content);
  EXPECT_THAT(
      html,
      AllOf(HasSubstr("<td>0,2</td><td>1,12</td>"), HasSubstr(">accepted<"),
            HasSubstr("<td>4.50</td><td>17</td><td>321.5</td><td>62 %</td>"
                      "<td>87.5 %</td><td>1.6 %</td><td>0.062</td>"
                      "<td>1.25</td><td>-2.50</td><td>90.0</td>")));
  EXPECT_THAT(html, Not(HasSubstr(">refused<")));
}

TEST(HtmlReportTest, EmbedsPicturesThatDecode) {
  ReportContent content;
  content.maps = {{"map", SmallPng()}};
  const std::string html = RenderReport(content);
  const std::string prefix = "data:image/png;base64,";
  const size_t begin = html.find(prefix) + prefix.size();
  std::string png;
  ASSERT_TRUE(absl::Base64Unescape(
      html.substr(begin, html.find('"', begin) - begin), &png));
  const DecodedPng decoded = DecodePng(png);
  EXPECT_EQ(decoded.width, 3);
  EXPECT_EQ(decoded.At(2, 1), (Rgb{255, 0, 0}));
}

TEST(HtmlReportTest, LimitsItsSize) {
  ReportContent content = TestContent();
  EXPECT_EQ(Count(RenderReport(content), "data:image/png"), 2 + 6);
  EXPECT_EQ(Count(RenderReport(content), "<td>1,1"), 6);
  content.closures.resize(200, TestClosure(0));
  for (ReportedClosure& closure : content.closures) {
    closure.png = std::string(500000, 'x');
  }
  const std::string html = RenderReport(content);
  EXPECT_LT(html.size(), size_t{30} << 20);
  EXPECT_EQ(Count(html, "data:image/png"), 2 + 41);
  EXPECT_THAT(html, HasSubstr("159 pictures are left out"));
  content.num_undrawn = 3;
  EXPECT_THAT(RenderReport(content), HasSubstr("162 pictures are left out"));
}

TEST(HtmlReportTest, LeavesOutWhatIsEmpty) {
  ReportContent content;
  content.title = "empty";
  const std::string html = RenderReport(content);
  EXPECT_EQ(MarkupError(html), "");
  EXPECT_THAT(html, Not(HasSubstr("<h2>")));
  content.stages = {{"nothing", 0.}};
  EXPECT_THAT(RenderReport(content),
              AllOf(HasSubstr("<h2>Time</h2>"), Not(HasSubstr("nan"))));
}

TEST(HtmlReportTest, WritesIntoANewDirectory) {
  const testing::TemporaryDirectory directory;
  const std::string path = directory.File("a/b");
  ASSERT_TRUE(WriteReport(path, TestContent()).ok());
  ASSERT_TRUE(WriteReport(path, TestContent()).ok());
  EXPECT_EQ(directory.Read("a/b/index.html"), RenderReport(TestContent()));
  // Nothing temporary is left.
  int num_files = 0;
  for (const auto& unused : std::filesystem::directory_iterator(path)) {
    static_cast<void>(unused);
    ++num_files;
  }
  EXPECT_EQ(num_files, 1);
}

TEST(HtmlReportTest, SaysWhereItCannotWrite) {
  const testing::TemporaryDirectory directory;
  directory.Write("file", "");
  const absl::Status status =
      WriteReport(directory.File("file/x"), TestContent());
  EXPECT_FALSE(status.ok());
  EXPECT_THAT(std::string(status.message()),
              HasSubstr(directory.File("file/x")));
}

}  // namespace
}  // namespace cartographer_sdf::html_report_test
