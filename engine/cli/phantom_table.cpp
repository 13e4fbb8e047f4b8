// The command `phantom table`. Rows are measured once and shown in every table they belong to. A cell
// that holds mean and standard deviation is one column for people and two in tab-separated text.
#include "engine/cli/phantom_table.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
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
PhantomLine line_of(const Phantom& phantom) {
    ModelTask task;
    task.identity.id = "phantom";
    task.options.endpoints.inlets = {phantom.truth.position(0)};
    task.options.endpoints.outlets = {phantom.truth.position(phantom.truth.total_length())};
    const TriangleSoup soup = to_soup(phantom);
    const ModelRecord record = process_model(task, [&](const ModelTask&) { return soup; });
    if (record.failure) throw std::runtime_error(record.failure->sentence);
    return {record.centerlines->points, record.centerlines->radius, record.facts.total_seconds};
}

class Tables {
public:
    explicit Tables(const TableArguments& arguments) : arguments_(arguments) {
        for (const std::string& wanted : arguments.rows) {
            bool known = false;
            for (const PaperRow& row : paper_rows()) known = known || row.name == wanted;
            for (const NoiseRow& row : noise_rows()) known = known || row.name == wanted;
            if (!known) throw std::invalid_argument("--rows: there is no row '" + wanted + "', known are: " + names());
        }
    }

    void print(std::ostream& out) {
        paper_table("Table 1", &PaperRow::in_table_1).print(out);
        paper_table("Table 2", &PaperRow::in_table_2).print(out);
        noise_table().print(out);
    }

private:
    static std::string names() {
        std::string all;
        for (const PaperRow& row : paper_rows()) all += (all.empty() ? "" : ", ") + std::string(row.name);
        for (const NoiseRow& row : noise_rows()) all += ", " + std::string(row.name);
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
        phantom.add_subcommand("table", "Measure the lines of phantoms: the paper's Tables 1 and 2, noise");
    verb->add_option("--seeds", arguments->seeds, "Meshes of every row, with seeds 1, 2, ...")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    verb->add_option("--rows", arguments->rows, "Only these rows, as 3/5-10 or torus-40-5% (comma-separated)")
        ->delimiter(',');
    verb->add_flag("--tsv", arguments->tsv, "Tab-separated, mean and standard deviation in columns of their own");
    verb->footer(
        "Errors in percent, mean(standard deviation) along the line, weighted by arc length, then the mean over "
        "seeds:\n"
        "position by the section's greatest radius, radius by its least. Rows are aspect ratio or shape, points "
        "around,\n"
        "and noise along the normal in percent of an edge. All meshes have 20 % tangential jitter and open ends.\n"
        "position, radius: all of the line but 0.25 a at the openings; _inner: without 1.2 a at either end; growth:\n"
        "length of the line by that of the axis, less one, mean(standard deviation) over seeds; seconds: all stages "
        "in\n"
        "one thread; paper_: Antiga, Ene-Iordache, Remuzzi 2003, on the machine of the time.\n"
        "Example: lumenline phantom table --seeds 1 --rows 5/5-10,3/5-10\n"
        "Exit status: 0 done, 1 a line failed, 2 usage error.");
    verb->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

}  // namespace lumenline
