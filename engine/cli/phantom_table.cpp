// The command `phantom table`. Rows are measured once and shown in every table they belong to. A cell
// that holds mean and standard deviation is one column for people and two in tab-separated text.
#include "engine/cli/phantom_table.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <ctime>
#include <map>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/cli/run.h"
#include "engine/cli/standard_output.h"
#include "engine/cli/table.h"
#include "engine/phantom/paper_tables.h"
#include "engine/schedule/model_job.h"

namespace lumenline {
namespace {

struct TableArguments {
    std::vector<std::string> rows;
    int seeds = 5;
    bool tsv = false;
};

/// A table in the making: text in columns for people, or tab-separated.
class Sheet {
public:
    Sheet(std::string title, bool tsv) : title_(std::move(title)), tsv_(tsv) {}

    void column(const std::string& heading) { headings_.push_back(heading); }
    void pair_column(const std::string& heading) {
        if (tsv_)
            headings_.insert(headings_.end(), {heading + "_mean", heading + "_sigma"});
        else
            headings_.push_back(heading);
    }
    void start_row() { rows_.emplace_back(); }
    void cell(const std::string& text) { rows_.back().push_back(text); }
    void cell(double value, int decimals) { cell(fmt::format("{:.{}f}", value, decimals)); }
    void pair(double mean, double sigma, int decimals) {
        if (tsv_) {
            cell(mean, decimals);
            cell(sigma, decimals);
        } else {
            cell(fmt::format("{:.{}f}({:.{}f})", mean, decimals, sigma, decimals));
        }
    }
    void errors(const ErrorFigures& e, int decimals) {
        pair(e.position, e.position_sigma, decimals);
        pair(e.radius, e.radius_sigma, decimals);
    }

    void print(std::ostream& out) const {
        if (rows_.empty()) return;
        if (tsv_) {
            out << "table\t" << fmt::format("{}", fmt::join(headings_, "\t")) << '\n';
            for (const auto& row : rows_) out << title_ << '\t' << fmt::format("{}", fmt::join(row, "\t")) << '\n';
        } else {
            TextTable table;
            for (std::size_t i = 0; i < headings_.size(); ++i)
                table.add_column(headings_[i], i == 0 ? TextTable::Align::kLeft : TextTable::Align::kRight);
            for (const auto& row : rows_) table.add_row(row);
            out << title_ << '\n';
            table.print(out);
        }
        out << '\n';
    }

private:
    std::string title_;
    bool tsv_;
    std::vector<std::string> headings_;
    std::vector<std::vector<std::string>> rows_;
};

/// All stages, as for any model.
ModelRecord record_of(const Phantom& phantom, bool characterize) {
    ModelTask task;
    task.options.condition.refine_undersampled = false;  // the mesh as it is
    task.options.characterize = characterize;
    task.identity.id = "phantom";
    task.options.endpoints.inlets = {phantom.truth.position(0)};
    task.options.endpoints.outlets = {phantom.truth.position(phantom.truth.total_length())};
    const TriangleSoup soup = to_soup(phantom);
    ModelRecord record = process_model(task, [&](const ModelTask&) { return soup; });
    if (record.failure) throw std::runtime_error(record.failure->sentence);
    return record;
}

PhantomLine line_of(const Phantom& phantom) {
    // Time of the processor: on a busy machine the clock on the wall tells of its other work.
    const std::clock_t start = std::clock();
    const ModelRecord record = record_of(phantom, false);
    const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    return {record.centerlines->points, record.centerlines->radius, seconds};
}

class Tables {
public:
    explicit Tables(const TableArguments& arguments) : arguments_(arguments) {
        for (const std::string& wanted : arguments.rows) {
            bool known = false;
            for (const PaperRow& row : paper_rows()) known = known || row.name == wanted;
            for (const NoiseRow& row : noise_rows()) known = known || row.name == wanted;
            for (const CharacterRow& row : character_rows()) known = known || row.name == wanted;
            if (!known) throw std::invalid_argument("--rows: there is no row '" + wanted + "', known are: " + names());
        }
    }

    void print(std::ostream& out) {
        paper_table("Table 1", &PaperRow::in_table_1).print(out);
        paper_table("Table 2", &PaperRow::in_table_2).print(out);
        noise_table().print(out);
        character_table().print(out);
    }

private:
    static std::string names() {
        std::string all;
        for (const PaperRow& row : paper_rows()) all += (all.empty() ? "" : ", ") + std::string(row.name);
        for (const NoiseRow& row : noise_rows()) all += ", " + std::string(row.name);
        for (const CharacterRow& row : character_rows()) all += ", " + std::string(row.name);
        return all;
    }

    [[nodiscard]] bool wanted(std::string_view name) const {
        return arguments_.rows.empty() ||
               std::find(arguments_.rows.begin(), arguments_.rows.end(), name) != arguments_.rows.end();
    }

    const RowFigures& figures(const PaperRow& row) {
        const auto found = measured_.find(row.name);
        if (found != measured_.end()) return found->second;
        return measured_.emplace(row.name, measure(row, arguments_.seeds, line_of)).first->second;
    }

    Sheet paper_table(const std::string& title, bool PaperRow::*in_table) {
        Sheet sheet(title, arguments_.tsv);
        sheet.column("row");
        for (const char* heading :
             {"paper_position", "paper_radius", "position", "radius", "position_inner", "radius_inner"})
            sheet.pair_column(heading);
        for (const char* heading : {"paper_vertices", "vertices", "paper_seconds", "seconds"}) sheet.column(heading);
        for (const PaperRow& row : paper_rows()) {
            if (!(row.*in_table) || !wanted(row.name)) continue;
            const RowFigures& ours = figures(row);
            sheet.start_row();
            sheet.cell(std::string(row.name));
            sheet.errors(row.paper, 2);
            sheet.errors(ours.whole.mean(), 3);
            sheet.errors(ours.inner.mean(), 3);
            sheet.cell(row.paper_vertices ? std::to_string(*row.paper_vertices) : "-");
            sheet.cell(ours.vertices.mean(), 0);
            sheet.cell(row.paper_seconds ? fmt::format("{:.2f}", *row.paper_seconds) : "-");
            sheet.cell(ours.seconds.mean(), 3);
        }
        return sheet;
    }

    Sheet noise_table() {
        Sheet sheet("Noise", arguments_.tsv);
        sheet.column("row");
        for (const char* heading : {"position", "radius", "position_inner", "radius_inner", "growth"})
            sheet.pair_column(heading);
        for (const NoiseRow& row : noise_rows()) {
            if (!wanted(row.name)) continue;
            const RowFigures ours = measure(row, arguments_.seeds, line_of);
            sheet.start_row();
            sheet.cell(std::string(row.name));
            sheet.errors(ours.whole.mean(), 3);
            sheet.errors(ours.inner.mean(), 3);
            sheet.pair(ours.growth.mean(), ours.growth.deviation(), 3);
        }
        return sheet;
    }

    Sheet character_table() {
        Sheet sheet("Characterization", arguments_.tsv);
        for (const char* heading : {"row", "sites", "unreached"}) sheet.column(heading);
        for (const char* pole : {"pole", "refined"})
            for (const char* heading : {"distance_mean", "distance_max", "ntd_mean", "ntd_max"})
                sheet.column(std::string(pole) + "_" + heading);
        for (const CharacterRow& row : character_rows()) {
            if (!wanted(row.name)) continue;
            const CharacterFigures ours =
                measure(row, arguments_.seeds, [](const Phantom& phantom) { return record_of(phantom, true); });
            sheet.start_row();
            sheet.cell(std::string(row.name));
            sheet.cell(std::to_string(ours.sites));
            sheet.cell(std::to_string(ours.unreached));
            for (const CharacterErrors& e : {ours.pole, ours.refined}) {
                for (const double distance : {e.distance_mean, e.distance_max}) sheet.cell(distance, 3);
                for (const double deviation : {e.deviation_mean, e.deviation_max}) sheet.cell(deviation, 4);
            }
        }
        return sheet;
    }

    const TableArguments& arguments_;
    std::map<std::string_view, RowFigures> measured_;
};

int run(const TableArguments& arguments) {
    try {
        Tables tables(arguments);
        to_standard_output([&](std::ostream& out) { tables.print(out); });
    } catch (const std::invalid_argument& error) {
        fmt::print(stderr, "lumenline phantom table: {}\n", error.what());
        return kUsage;
    }
    return kDone;
}

}  // namespace

void add_phantom_table(CLI::App& phantom, std::function<int()>& action) {
    auto arguments = std::make_shared<TableArguments>();
    CLI::App* verb =
        phantom.add_subcommand("table", "Measure phantoms: the paper's Tables 1 and 2, noise, characterization");
    verb->add_option("--seeds", arguments->seeds, "Meshes of every row, with seeds 1, 2, ...")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    verb->add_option("--rows", arguments->rows, "Only these rows, as 3/5-10 or torus-40-5% (comma-separated)")
        ->delimiter(',');
    verb->add_flag("--tsv", arguments->tsv, "Tab-separated, mean and standard deviation in columns of their own");
    verb->footer(
        "Errors in percent, mean(standard deviation) along the line, weighted by arc length, then the mean over\n"
        "seeds: position by the section's greatest radius, radius by its least. Rows are aspect ratio or shape, "
        "points\n"
        "around, and noise along the normal in percent of an edge. All meshes have 20 % tangential jitter, open\n"
        "ends, and no sites added. position, radius: all of the line but 0.25 a at the openings; _inner: without 1.2 a "
        "at either end;\n"
        "growth: length of the line by that of the axis, less one, mean(standard deviation) over seeds; seconds: of\n"
        "the processor, all stages up to the line; paper_: Antiga, Ene-Iordache, Remuzzi 2003, on the machine of\n"
        "the time. Characterization: errors of D_g in percent of a, and of NTD, on the 3/5 cylinder against its\n"
        "closed form, with the paper's pole and refined.\n"
        "Example: lumenline phantom table --seeds 1 --rows 5/5-10,3/5-10\n"
        "Exit status: 0 done, 1 a line failed, 2 usage error.");
    verb->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace lumenline
