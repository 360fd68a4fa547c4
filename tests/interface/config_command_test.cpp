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

TEST(ConfigCommand, TheReferencePageIsWhatTheProgramPrints) {
  const ProgramRun run = run_program("config reference");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(content(kSource / "docs/configuration.md"), run.out)
      << "repair: holdfast config reference > docs/configuration.md";
}

TEST(ConfigCommand, TheShippedDefaultIsWhatTheProgramPrints) {
  const ProgramRun run = run_program("config default");
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(content(kSource / "config/default.yaml"), run.out)
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
