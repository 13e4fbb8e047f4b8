// The tree is built from yaml-cpp's events instead of its YAML::Node, because Node keeps the first of
// duplicate keys without a word and forgets the lines of keys. yaml-cpp counts lines from 0, places an
// absent value at the token that follows it (hence the key's line for nulls), and knows no merge keys:
// it would hand `<<` on as a plain key. A quote that is open at the end of the input passes for closed
// when a line feed comes last; a document end marker behind the text turns that into an error.

#include "config/document.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <array>
#include <map>
#include <sstream>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "config/cohort.h"
#include "config/values.h"

namespace lumenline {

namespace {

using NodePtr = std::shared_ptr<const YamlNode>;

std::size_t line_of(const YAML::Mark& mark) { return mark.is_null() ? 1 : static_cast<std::size_t>(mark.line) + 1; }

/// Turns one document's events into a tree and refuses what a configuration must not contain.
class TreeBuilder : public YAML::EventHandler {
public:
    explicit TreeBuilder(const std::filesystem::path& file) : file_(file) {}

    [[nodiscard]] NodePtr root() const { return root_; }

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (documents_++ > 0) refuse(line_of(mark), "a second YAML document starts here; a cohort is one document");
    }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        const bool is_value = !open_.empty() && open_.back().has_key;
        add(make(YamlNode::Kind::kNull, is_value ? open_.back().key_line : line_of(mark)), anchor);
    }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
        const auto found = anchors_.find(anchor);
        if (found == anchors_.end()) refuse(line_of(mark), "an alias stands inside of the value that it refers to");
        attach(found->second, line_of(mark));
    }
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  const std::string& value) override {
        check_tag(mark, tag);
        const std::shared_ptr<YamlNode> node = make(YamlNode::Kind::kScalar, line_of(mark));
        node->is_quoted = tag == "!";
        node->text = value;
        add(node, anchor);
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                         YAML::EmitterStyle::value /*style*/) override {
        open(mark, tag, anchor, YamlNode::Kind::kSequence);
    }
    void OnSequenceEnd() override { close(); }
    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                    YAML::EmitterStyle::value /*style*/) override {
        open(mark, tag, anchor, YamlNode::Kind::kMap);
    }
    void OnMapEnd() override { close(); }

private:
    /// A sequence or map whose end has not been seen.
    struct Open {
        std::shared_ptr<YamlNode> node;
        YAML::anchor_t anchor = 0;
        bool has_key = false;  // of a map: the key is read, its value is to come
        std::string key;
        std::size_t key_line = 0;
        std::unordered_map<std::string, std::size_t> lines;  // of a map's keys so far
    };

    [[noreturn]] void refuse(std::size_t line, const std::string& sentence) const {
        throw ConfigError(file_, line, sentence);
    }

    void check_tag(const YAML::Mark& mark, const std::string& tag) const {
        if (!tag.empty() && tag != "?" && tag != "!")
            refuse(line_of(mark), fmt::format("YAML tags are not supported; remove the tag {}", in_quotes(tag)));
    }

    static std::shared_ptr<YamlNode> make(YamlNode::Kind kind, std::size_t line) {
        auto node = std::make_shared<YamlNode>();
        node->kind = kind;
        node->line = line;
        return node;
    }

    void open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor, YamlNode::Kind kind) {
        check_tag(mark, tag);
        if (!open_.empty() && open_.back().node->kind == YamlNode::Kind::kMap && !open_.back().has_key)
            refuse(line_of(mark), "a key must be plain text, not a list or a map");
        Open collection;
        collection.node = make(kind, line_of(mark));
        collection.anchor = anchor;
        open_.push_back(std::move(collection));
    }

    void close() {
        const Open done = std::move(open_.back());
        open_.pop_back();
        add(done.node, done.anchor);
    }

    void add(const NodePtr& node, YAML::anchor_t anchor) {
        if (anchor != 0) anchors_[anchor] = node;
        attach(node, node->line);
    }

    void attach(const NodePtr& node, std::size_t line) {
        if (open_.empty()) {
            root_ = node;
            return;
        }
        Open& parent = open_.back();
        if (parent.node->kind == YamlNode::Kind::kSequence) {
            parent.node->items.push_back(node);
        } else if (parent.has_key) {
            parent.node->entries.push_back({std::move(parent.key), parent.key_line, node});
            parent.has_key = false;
        } else {
            take_key(parent, *node, line);
        }
    }

    void take_key(Open& map, const YamlNode& key, std::size_t line) const {
        if (key.kind != YamlNode::Kind::kScalar) refuse(line, "a key must be plain text and not empty");
        if (key.text == "<<" && !key.is_quoted)
            refuse(line, "merge keys ('<<') are not supported; repeat the keys, or use an alias for a whole value");
        const auto [first, is_new] = map.lines.try_emplace(key.text, line);
        if (!is_new)
            refuse(line, fmt::format("the key {} appears twice; the first is in line {}", in_quotes(key.text),
                                     first->second));
        map.key = key.text;
        map.key_line = line;
        map.has_key = true;
    }

    const std::filesystem::path& file_;
    int documents_ = 0;
    NodePtr root_;
    std::vector<Open> open_;
    std::map<YAML::anchor_t, NodePtr> anchors_;
};

/// yaml-cpp's messages in words that help someone who does not know its grammar.
std::string readable(const std::string& message) {
    using Words = std::pair<std::string_view, std::string_view>;
    static const std::array kWords{
        Words{YAML::ErrorMsg::TAB_IN_INDENTATION, "a tab is used for indentation; use spaces"},
        Words{YAML::ErrorMsg::END_OF_MAP, "the line does not fit the keys above it; check indentation and ':'"},
        Words{YAML::ErrorMsg::END_OF_SEQ, "the line does not fit the list above it; check indentation and '-'"},
        Words{YAML::ErrorMsg::END_OF_MAP_FLOW, "a '{' is not closed, or a ',' is missing"},
        Words{YAML::ErrorMsg::END_OF_SEQ_FLOW, "a '[' is not closed, or a ',' is missing"},
        Words{YAML::ErrorMsg::FLOW_END, "a ']' or '}' closes nothing"},
        Words{YAML::ErrorMsg::EOF_IN_SCALAR, "a quote is not closed"},
        Words{YAML::ErrorMsg::DOC_IN_SCALAR, "a quote is not closed"},
        Words{YAML::ErrorMsg::MAP_VALUE, "a ':' is out of place; put text that contains ': ' in quotes"},
        Words{YAML::ErrorMsg::MAP_KEY, "a '?' is out of place; put text that starts with it in quotes"},
        Words{YAML::ErrorMsg::BLOCK_ENTRY, "a '- ' is out of place; check the indentation"},
        Words{YAML::ErrorMsg::UNKNOWN_TOKEN, "a character cannot start a value here; put the text in quotes"},
        Words{YAML::ErrorMsg::UNKNOWN_ANCHOR, "an alias ('*name') refers to an anchor that is not defined above it"},
    };
    const auto found = std::ranges::find(kWords, std::string_view(message), &Words::first);
    return found == kWords.end() ? message : std::string(found->second);
}

}  // namespace

const YamlEntry* YamlNode::find(std::string_view key) const {
    const auto found = std::ranges::find(entries, key, &YamlEntry::key);
    return found == entries.end() ? nullptr : &*found;
}

std::shared_ptr<const YamlNode> parse_yaml(const std::string& text, const std::filesystem::path& file) {
    TreeBuilder builder(file);
    try {
        std::istringstream in(text + "\n...\n");
        YAML::Parser parser(in);
        while (parser.HandleNextDocument(builder)) {
        }
    } catch (const YAML::Exception& error) {
        const auto last = static_cast<std::size_t>(std::ranges::count(text, '\n') + (text.ends_with('\n') ? 0 : 1));
        throw ConfigError(file, std::clamp<std::size_t>(line_of(error.mark), 1, std::max<std::size_t>(last, 1)),
                          "not valid YAML: " + readable(error.msg));
    }
    if (!builder.root() || builder.root()->kind == YamlNode::Kind::kNull)
        throw ConfigError(file, 1, "the file is empty; it must at least have the keys 'cohort' and 'models'");
    return builder.root();
}

}  // namespace lumenline
