// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/large_pages.hpp"
#include "trussmap/texts.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::diagnosis_page_test {
using namespace report;
namespace {

/// A diagnosis with two effects missing, of which the second is as unsure as `sd` says.
Page page_with_second(double sd) {
  EffectEvidence second = testing::large_effect();
  second.estimate.sd = {sd, sd};
  const ModelEvidence model = testing::large_model(50);
  const DiagnosisEvidence evidence{model,
                                   model,
                                   {testing::large_effect(), second},
                                   testing::large_trends(),
                                   std::vector<FindingSize>(2)};
  return diagnosis_page(testing::large_diagnosis(50), evidence, "a recording");
}

std::vector<std::string> answers_to(const Page& page, const std::string& question) {
  std::vector<std::string> answers;
  for (const PageAnswer& one : page.content().answers) {
    if (one.question == question) answers.push_back(one.answer);
  }
  return answers;
}

TEST(DiagnosisPage, SaysHowLargeEachOfSeveralEffectsIs) {
  const Page page = page_with_second(0.001);
  EXPECT_NE(page.content().verdict.find("hard iron (\u00b12.9\u00b0), or body tilt; and hard iron "
                                        "(\u00b12.9\u00b0), or body tilt"),
            std::string::npos)
      << page.content().verdict;
  const std::vector<std::string> sizes = answers_to(page, "How large?");
  ASSERT_EQ(sizes.size(), 2U);
  EXPECT_NE(sizes[1].find("2.865 \u00b1 0.057\u00b0"), std::string::npos) << sizes[1];
  EXPECT_EQ(sizes[1].find("hardly seen"), std::string::npos) << sizes[1];
}

TEST(DiagnosisText, SaysWhatShowsOnlyBesideTheFirst) {
  Diagnosis diagnosis;
  diagnosis.verdict = Diagnosis::Verdict::missing;
  diagnosis.missing = "hard iron";
  for (const char* name : {"hard iron", "turn asymmetry", "slope"}) {
    Finding one;
    one.effect = {name, Channel::turn, {"1"}, {0.1}};
    one.joint = {0.1};
    one.joint_sd = {0.01};
    one.status = diagnosis.findings.size() < 2 ? Status::missing : Status::cannot_tell;
    one.p_adjusted = diagnosis.findings.empty() ? 1e-9 : 0.9;
    diagnosis.findings.push_back(one);
  }
  const std::string text = diagnosis_text(diagnosis, {}, 8);
  const auto row = [&text](const std::string& name) {
    const std::size_t at = text.find("\n  " + name, text.find("best candidates")) + 1;
    return text.substr(at, text.find('\n', at) - at);
  };
  EXPECT_EQ(row("hard iron").find("with the above"), std::string::npos) << text;
  EXPECT_NE(row("turn asymmetry").find("with the above"), std::string::npos) << text;
  EXPECT_NE(row("slope").find("0.90"), std::string::npos) << text;
}

TEST(DiagnosisPage, SaysWhatTheOtherEffectsMakeSuperfluous) {
  const std::vector<std::string> sizes = answers_to(page_with_second(0.03), "How large?");
  ASSERT_EQ(sizes.size(), 2U);
  EXPECT_EQ(sizes[0].find("hardly seen"), std::string::npos) << sizes[0];
  EXPECT_NE(sizes[1].find("beside the others it is hardly seen"), std::string::npos) << sizes[1];
}

TEST(DiagnosisPage, BeginsWithPicturesAndClosesTables) {
  const Page page = page_with_second(0.001);
  const std::vector<PageSection>& sections = page.content().sections;
  ASSERT_FALSE(sections.empty());
  ASSERT_FALSE(sections.front().blocks.empty());
  EXPECT_TRUE(std::holds_alternative<ChartRow>(sections.front().blocks.front()));
  std::size_t closed = 0;
  for (const PageSection& section : sections) {
    for (const PageBlock& block : section.blocks) {
      EXPECT_FALSE(std::holds_alternative<PageTable>(block)) << section.title;
    }
    for (const PageBlock& block : section.details) {
      closed += std::holds_alternative<PageTable>(block) ? 1 : 0;
    }
  }
  EXPECT_GT(closed, 3U);
}

}  // namespace
}  // namespace trussmap::diagnosis_page_test
