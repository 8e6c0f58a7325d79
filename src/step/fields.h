#pragma once

#include <kropla/transfer/transfer.h>

#include <array>
#include <concepts>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

namespace kropla {

/// How a field is carried from mesh to mesh.
struct Carrying {
    std::vector<double> weight = {};  // per region: the density whose integral is kept and reported; empty: 1
    Region only = {};                 // per vertex: a field of this region alone, elsewhere without meaning
    bool limit = true;                // keep the bounds of the old cells that overlap (always, per cell)
};

/// The fields that go with a moving mesh: arrays of the caller's, of numbers, vectors or structs of his own, one item for
/// each slot of the mesh; they are carried in place, grow with the mesh, and can be put back as they were. A field that
/// has a value on each side of an interface is one array per region, `only` of it; a field at several times, one array
/// per time. The arrays are to outlive this, where they are.
///
///     Array<Vertex, double> temperature(mesh.position.size(), 300);
///     struct Cell { double fraction; Vec3 drift; int kind; };
///     std::vector<Cell> cells(mesh.tets.size());
///     Fields fields;
///     fields.per_vertex(temperature);
///     fields.per_cell(cells, &Cell::fraction, &Cell::drift);  // `kind` is kept, and copied by nothing
///
/// A slot that is new, or free and taken again, has what the transfer says in the members that are carried, and in all
/// others what stood there, or T{}.
class Fields {
public:
    void per_vertex(Array<Vertex, double>& values, Carrying how = {}) { add(true, values, std::move(how), std::identity{}); }
    void per_vertex(Array<Vertex, Vec3>& values, Carrying how = {}) { add(true, values, std::move(how), std::identity{}); }
    void per_cell(Array<Tet, double>& values, Carrying how = {}) { add(false, values, std::move(how), std::identity{}); }
    void per_cell(Array<Tet, Vec3>& values, Carrying how = {}) { add(false, values, std::move(how), std::identity{}); }
    void per_vertex(std::vector<double>& values, Carrying how = {}) { add(true, values, std::move(how), std::identity{}); }
    void per_cell(std::vector<double>& values, Carrying how = {}) { add(false, values, std::move(how), std::identity{}); }
    /// Of structs, these members: of type double or Vec3.
    template <class T, class... Member>
        requires(sizeof...(Member) > 0)
    void per_vertex(std::vector<T>& values, Member T::*... members) {
        add(true, values, {}, member(members)...);
    }
    template <class T, class... Member>
        requires(sizeof...(Member) > 0)
    void per_cell(std::vector<T>& values, Member T::*... members) {
        add(false, values, {}, member(members)...);
    }

    [[nodiscard]] bool empty() const { return fields_.empty(); }

    /// A copy of all arrays; and puts them back, bit for bit, and as long as they were.
    class Copy {
    public:
        void put_back() const {
            for (const auto& restore : restore_) restore();
        }

    private:
        friend class Fields;
        std::vector<std::function<void()>> restore_;
    };
    [[nodiscard]] Copy copy() const;

    /// Carries all of them by the plan; the reports are in the order in which fields were added, each over its
    /// components. Throws as `project` does; then some may have been carried.
    std::vector<TransferReport> carry(const TransferPlan& plan, const Watch* watch = nullptr);

    /// Throws std::logic_error if an array has not an item for each slot of the mesh.
    void check_sizes(const Mesh& mesh) const;

private:
    struct Field {
        bool of_vertices;
        Carrying how;
        std::size_t stride;  // [doubles] from item to item
        std::function<std::size_t()> size;
        std::function<void(std::size_t)> resize;
        std::function<std::function<void()>()> copy;                  // what puts the items back
        std::vector<std::function<std::span<double>()>> components;   // that lie side by side in the first item
    };

    template <class T, class M>
    static auto member(M T::*which) {
        return [which](T& item) -> M& { return item.*which; };
    }
    static std::span<double> numbers(double& value) { return {&value, 1}; }
    static std::span<double> numbers(Vec3& value) { return {&value.x, 3}; }

    template <class Items, class... Part>
    void add(bool of_vertices, Items& items, Carrying how, Part... part) {
        using T = std::remove_reference_t<decltype(*items.data())>;
        static_assert(std::copyable<T> && std::default_initializable<T>);
        static_assert(sizeof(T) % sizeof(double) == 0, "the numbers of items are to lie at even distances");
        fields_.push_back({of_vertices, std::move(how), sizeof(T) / sizeof(double),
                           [&items] { return items.size(); },
                           [&items](std::size_t size) { items.resize(size); },
                           [&items] { return std::function<void()>([&items, kept = items] { items = kept; }); },
                           {[&items, part] { return numbers(part(*items.data())); }...}});
    }

    std::vector<Field> fields_;
};

}  // namespace kropla
