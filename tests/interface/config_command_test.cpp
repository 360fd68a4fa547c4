#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "holdfast/pipeline/config.hpp"
#include "tests/interface/program.hpp"

namespace holdfast::testing {
namespace {

const std::filesystem::path kSource = HOLDFAST_SOURCE;

std::string content(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// The first line in which two texts differ; empty when they are equal.
std::string first_difference(const std::string& file, const std::string& program) {
  std::istringstream a(file);
  std::istringstream b(program);
  std::string in_file;
  std::string in_program;
  while (true) {
    const bool more_a = static_cast<bool>(std::getline(a, in_file));
    const bool more_b = static_cast<bool>(std::getline(b, in_program));
    if (!more_a && !more_b) return file == program ? "" : "the ends of the last lines differ";
    if (!more_a) in_file = "(end of file)";
    if (!more_b) in_program = "(end)";
    if (in_file != in_program) return "file: " + in_file + "\nprogram: " + in_program;
  }
}

TEST(ConfigCommand, TheReferencePageIsWhatTheProgramPrints) {
  const ProgramRun run = run_program("config reference");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(first_difference(content(kSource / "docs/configuration.md"), run.out), "")
      << "repair: holdfast config reference > docs/configuration.md";
}

TEST(ConfigCommand, ThePageOfScenarioFilesIsWhatTheProgramPrints) {
  const ProgramRun run = run_program("simulate --reference");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(first_difference(content(kSource / "docs/simulator.md"), run.out), "")
      << "repair: holdfast simulate --reference > docs/simulator.md";
}

TEST(ConfigCommand, TheShippedDefaultIsWhatTheProgramPrints) {
  const ProgramRun run = run_program("config default");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(first_difference(content(kSource / "config/default.yaml"), run.out), "")
      << "repair: holdfast config default > config/default.yaml";
}

TEST(ConfigCommand, WithoutAWordOrWithAnUnknownOneItIsWrongUsage) {
  EXPECT_EQ(run_program("config").exit_code, 2);
  EXPECT_EQ(run_program("config everything").exit_code, 2);
  EXPECT_EQ(run_program("config --help").exit_code, 0);
}

TEST(ShippedConfigurations, AreAllReadWithoutAnError) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kSource / "config")) {
    if (entry.path().extension() != ".yaml") continue;
    pipeline::Config config;
    auto fields = pipeline::fields_of(config);
    const Status status = io::read_config_file(entry.path(), fields);
    EXPECT_TRUE(status) << status.error().message;
    ++files;
  }
  EXPECT_GE(files, 1);
}

}  // namespace
}  // namespace holdfast::testing
