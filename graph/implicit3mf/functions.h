// 3MF's functions as groups: one node of ours for each node of the function, wired as it is there.
//
// Why groups of nodes, and not code: a function calls others and meshes and pictures, which code cannot; the
// person who made it sees the nodes again, under their names. What no node of the library does is an
// expression of one line. Constants stand as numbers in the inputs that they feed, and as a node of their own
// where they feed several; `composevector` and its like are ours. Matrices, of which we have none, are
// sixteen numbers: those that are constant fold.
//
// A function that takes resources (the mesh or the function to use) becomes a group for each of those that it
// is given.
#pragma once

#include <functional>
#include <map>
#include <set>

#include "graph/document/graph.h"
#include "graph/implicit3mf/model.h"
#include "graph/implicit3mf/sheets.h"

namespace fw::threemf {

/// Text made an id ([a-z][a-z0-9_]*) that is not in `taken`, which it joins.
std::string freshId(std::string_view text, std::set<std::string, std::less<>>& taken);
/// "the function 'box' (id 4)"
std::string functionWords(const std::string& name, int id);
/// As a socket of a group may be called: "shape-diff" is shape_diff.
std::string socketName(const std::string& name);
InputValue linkTo(std::string node, std::string output = {});
/// The node at the end of `nodes`, with an id after `name`.
Node& addNode(std::vector<Node>& nodes, std::set<std::string, std::less<>>& taken, std::string type,
              std::string_view name);

/// "vec3(…)": the place `v` as a row times a matrix of four rows and three columns, row by row; each of its
/// entries a number or the name of one.
std::string productCode(const std::array<std::string, 12>& entries, const std::string& v);
std::string productCode(const Affine& matrix, const std::string& v);

/// A value within a group or the document: of a matrix sixteen numbers or links, row by row; else one.
struct Value {
    ValueType type = ValueType::scalar;
    std::vector<InputValue> parts = {};
    int resource = 0;
};

/// What the makers of groups need of the file.
struct FileNames {
    /// The mesh of an object as a file that a graph may name.
    std::function<Result<std::string>(const Object&)> mesh;
    /// The picture of a channel of an image stack, likewise.
    std::function<std::string(int stack, const SheetPicture&)> picture;
};

class FunctionGroups {
  public:
    FunctionGroups(const Model& model, const Package& package, Graph& graph, FileNames files);

    /// The group of a function that was given `resources`, by the names of its inputs. The Error has a
    /// message only: what of the function has no sense.
    using Resources = std::map<std::string, int>;
    Result<const Group*> group(int function, const Resources& resources = {}, int depth = 0);

    const Model& model;
    const FileNames files;
    std::vector<std::string> remarks;

  private:
    Result<std::size_t> ofFunction(const Function& function, const Resources& resources, int depth);
    Result<std::size_t> ofPictures(const ImageFunction& function);
    Result<const Sheets*> sheets(int stack);

    const Package& package;
    Graph& graph;
    std::set<std::string, std::less<>> groupIds;
    std::map<std::pair<int, Resources>, std::size_t> made;  // places in Graph::groups
    std::set<int> within;                                   // those that are being made
    std::map<int, Sheets> stacks;
    std::size_t nodes = 0;
};

}  // namespace fw::threemf
