#include <cstdio>
#include <string>

#include "apps/commands.hpp"
#include "holdfast/pipeline/config.hpp"

namespace holdfast::apps {
namespace {

constexpr const char* kReferenceHead = R"(# Configuration

This page is what `holdfast config reference` prints; a test keeps the two equal.

A configuration is a YAML file of modules with keys, as `holdfast config default` prints it. A file
holds differences only: keys that it does not name keep their defaults. Unknown keys, values of a
wrong type and values out of range are errors that name file and line, and the nearest known key. On
the command line, `--set module.key=value` comes after the file. Each run writes the configuration
that it used into its folder. Units stand in the names of the keys (`_m`, `_s`, `_hz`, `_deg`).

)";

constexpr const char* kDefaultHead =
    "# All keys with their defaults (`holdfast config default`); docs/configuration.md says what\n"
    "# they mean. A file of your own needs only what differs, and T_body_lidar.\n";

void print(const std::string& text) { std::fwrite(text.data(), 1, text.size(), stdout); }

}  // namespace

void add_config_command(CLI::App& app) {
  CLI::App* config =
      app.add_subcommand("config", "Print the default configuration or its reference");
  config->require_subcommand(1);
  config->add_subcommand("default", "All keys with their defaults, as YAML")->callback([] {
    pipeline::Config defaults;
    print(kDefaultHead + io::write_config(pipeline::fields_of(defaults)));
  });
  config->add_subcommand("reference", "What each key means, as Markdown")->callback([] {
    pipeline::Config defaults;
    print(kReferenceHead + io::config_reference(pipeline::fields_of(defaults)));
  });
}

}  // namespace holdfast::apps
