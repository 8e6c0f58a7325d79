#include "app/command_line.h"

#include "case/table.h"
#include <kropla/base/error.h>

#include <fmt/format.h>

#include <algorithm>

namespace kropla {
namespace {

std::vector<std::string> long_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    return names;
}

}  // namespace

void check_words(const CLI::App& app, const std::vector<std::string>& words) {
    if (words.empty() || words.front().starts_with('-')) return;
    std::vector<std::string> commands;
    for (const CLI::App* command : app.get_subcommands({})) commands.push_back(command->get_name());
    if (std::ranges::find(commands, words.front()) == commands.end())
        throw CaseError(fmt::format("{}: unknown command; {}", words.front(), suggestion(words.front(), commands)));
    const std::vector<std::string> known = long_names(*app.get_subcommand(words.front()));
    for (const std::string& word : words) {
        const std::string name = word.substr(0, word.find('='));
        if (!word.starts_with("--") || word == "--" || std::ranges::find(known, name) != known.end()) continue;
        throw CaseError(fmt::format("{}: unknown option of kropla {}; {}", name, words.front(), suggestion(name, known)));
    }
}

std::string what_is_wrong(const CLI::App& app, const CLI::ParseError& error) {
    const auto asked = app.get_subcommands();
    const std::string command = asked.empty() ? "kropla" : "kropla " + asked.front()->get_name();
    if (!asked.empty())
        for (const CLI::Option* option : asked.front()->get_options())
            if (option->get_required() && option->empty())
                return fmt::format("{} is missing: {} (see {} --help)", option->get_name(), option->get_description(),
                                   command);
    return fmt::format("{} (see {} --help)", error.what(), command);
}

}  // namespace kropla
