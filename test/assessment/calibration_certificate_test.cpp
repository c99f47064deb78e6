#include "spherical_actuator_calibration/assessment/calibration_certificate.hpp"

#include <string>

#include <gtest/gtest.h>

#include "spherical_actuator_calibration/base/error.hpp"
#include "support/scenarios.hpp"
#include "support/temporary_folder.hpp"

namespace sac {
namespace {

CalibrationSession sessionRefinedAtOnce() {
  scenarios::Generator generator(4);
  CalibrationSession session(
      {scenarios::paperNominal()},
      scenarios::paperSession(scenarios::paperTruth(), scenarios::Tracker::kEveryPose, generator),
      {});
  session.run({Cycle::kRefine});
  return session;
}

const CalibrationOrigin& origin() {
  static const CalibrationOrigin made = {
      "2024-05-31T12:00:00Z", {{"a&b.bag", "sha256:1"}}, "1.2.3"};
  return made;
}

std::string issuerError(const std::string& yaml) {
  const TemporaryFolder folder;
  try {
    loadCertificateIssuer(folder.write("issuer.yaml", yaml));
    return {};
  } catch (const ConfigError& error) {
    return error.what();
  }
}

bool holds(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(CalibrationCertificate, NamesWhoIssuesIt) {
  const CertificateIssuer issuer = {"Lab <1>", "Berlin", "DE", "A. Person", "A Customer", "C-17"};
  const std::string text = renderCertificate(sessionRefinedAtOnce(), origin(), issuer);
  EXPECT_TRUE(holds(text, "<dcc:uniqueIdentifier>C-17</dcc:uniqueIdentifier>"));
  EXPECT_TRUE(holds(text, "Lab &lt;1&gt;"));
  EXPECT_TRUE(holds(text, "a&amp;b.bag"));
  EXPECT_TRUE(holds(text, "<dcc:issueDate>2024-05-31</dcc:issueDate>"));
  EXPECT_FALSE(holds(text, "Draft"));
}

TEST(CalibrationCertificate, WithoutItIsADraft) {
  const std::string text = renderCertificate(sessionRefinedAtOnce(), origin(), {});
  EXPECT_TRUE(holds(text, "Draft: "));
  EXPECT_TRUE(holds(text, "<dcc:countryCode>ZZ</dcc:countryCode>"));
}

TEST(CalibrationCertificate, NeedsResults) {
  const CalibrationSession empty({scenarios::paperNominal()}, {}, {});
  EXPECT_THROW(renderCertificate(empty, origin(), {}), DataError);
}

TEST(CertificateIssuer, IsReadStrictly) {
  EXPECT_EQ(issuerError("certificate: {laboratory: L, country: DE}"), "");
  EXPECT_TRUE(holds(issuerError("certificate: {country: Germany}"), "certificate.country"));
  EXPECT_TRUE(holds(issuerError("certificate: {lab: L}"), "certificate.lab"));
}

}  // namespace
}  // namespace sac
