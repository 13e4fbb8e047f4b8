#include "io/archive/inspection.h"

#include "engine/core/text.h"
#include "io/archive/utf8.h"

namespace lumenline {

std::string Finding::sentence() const {
    return printable(place.empty() ? file + ": " + what : file + ": " + place + ": " + what);
}

void Inspection::report(const std::string& place, const std::string& what) {
    result_.findings.push_back({label_, place, what});
    sound_.erase(place);
}

bool Inspection::are_sound(std::initializer_list<const names::Field*> fields) const {
    for (const names::Field* field : fields)
        if (!is_sound(field->path)) return false;
    return true;
}

const Inspection::Numbers& Inspection::numbers(const std::string& path) {
    const auto [entry, is_new] = cache_.try_emplace(path);
    if (!is_new) return entry->second;
    try {
        entry->second = file_.numbers(path);
    } catch (const ArchiveError& error) {
        report(path, std::string("its values cannot be read: ") + error.what());
    }
    return entry->second;
}

std::vector<std::string> Inspection::strings(const std::string& path) {
    try {
        return file_.strings(path);
    } catch (const ArchiveError& error) {
        report(path, std::string("its text cannot be read: ") + error.what());
        return {};
    }
}

std::size_t Inspection::length(char letter) const {
    const auto found = lengths.find(letter);
    return found == lengths.end() ? 0 : found->second;
}

void Inspection::all_hold(const std::string& place, std::size_t count,
                          const std::function<std::string(std::size_t)>& tell) {
    std::size_t bad = 0;
    std::string first;
    for (std::size_t k = 0; k < count; ++k) {
        std::string wrong = tell(k);
        if (wrong.empty()) continue;
        if (bad++ == 0) first = std::move(wrong);
    }
    if (bad == 1) report(place, first);
    if (bad > 1) report(place, first + ", and " + std::to_string(bad - 1) + " more of " + std::to_string(count));
}

}  // namespace lumenline
