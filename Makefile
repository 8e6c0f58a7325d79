# make            builds build/release/bin/kropla
# make demo       runs the droplet case into demo/droplet and draws demo/pictures; what was there is replaced
# make test       builds and runs all tests
# make flood      500 random cases, each frame verified by code of its own: docs/reliability.md; N=20: fewer, SEED=2: others;
#                 FLOW=1: of bodies and liquids in a flow.
#                 A case that fails is left in flood/failed
# make bench      builds and runs the benchmarks; beside CGAL, if libcgal-dev is installed
# make bench-peers  the moving droplet by Kropla and by the mesh generators that are installed (Gmsh, TetGen), one
#                 table; STEPS=10: fewer meshes of the others
# make bench-flow  a step of flow around a moving sphere by Kropla and by OpenFOAM, if it is installed; STEPS=60: more
# make bench-drop  a drop that rings and one at rest by Kropla and by OpenFOAM, if it is installed; END=2.6: shorter
# make bench-engine  work in proportion to change, and what a second thread saves
# make bench-strategies  the same motion by our method, by the paper's and by three plainer ways, one table
# make bench-spread  ways to spread a body's displacement into its surroundings
# make bench-transfer  1000 transfers to and fro, by interpolation and by projection: docs/transfer.md
# make endurance  5000 steps of a droplet that wanders among bodies, bounds checked; STEPS=500: fewer
# make validate   heat, flow and drops, by problems with known solutions, as fine as the tests take them and finer:
#                 docs/validation.md
# make validate-modes  drops that ring, in two modes, against theory: the same page
# Each installs the Debian packages that are missing.

.PHONY: all demo test flood bench bench-peers bench-flow bench-drop bench-engine bench-strategies bench-spread \
        bench-transfer endurance validate validate-modes packages configure clean

all: configure
	cmake --build --preset release

packages:
	tools/install-packages

configure: packages
	@cmake --preset release >build-configure.log 2>&1 || { cat build-configure.log; rm build-configure.log; exit 1; }
	@rm -f build-configure.log

demo: all
	rm -rf demo/droplet demo/pictures
	build/release/bin/kropla run cases/droplet.toml --out demo/droplet
	tools/draw-pictures demo/droplet demo/pictures

test: all
	ctest --test-dir build/release --output-on-failure -j2

flood: all
	python3 tests/flood/flood.py build/release/bin/kropla --cases $(or $(N),500) --seed $(or $(SEED),1) \
		--failed flood/failed $(if $(FLOW),--flow) $(if $(MARKDOWN),--markdown)

bench: packages
	cmake --preset bench
	cmake --build --preset bench --target kropla_bench
	build/bench/bin/kropla_bench

bench-peers: packages
	cmake --preset bench
	cmake --build --preset bench --target kropla peers_measure peers_surfaces
	bench/peers/bench-peers build/bench/bin build/bench/peers $(if $(STEPS),--steps $(STEPS))

bench-flow: packages
	cmake --preset bench
	cmake --build --preset bench --target kropla
	bench/flow-peers build/bench/bin/kropla build/bench/flow $(if $(STEPS),--steps $(STEPS))

bench-drop: packages
	cmake --preset bench
	cmake --build --preset bench --target kropla
	bench/drop-peers build/bench/bin/kropla build/bench/drop $(if $(END),--end $(END))

bench-engine: packages
	cmake --preset bench
	cmake --build --preset bench --target kropla_engine
	build/bench/bin/kropla_engine $(STEPS)

bench-strategies: packages
	cmake --preset bench
	cmake --build --preset bench --target kropla_strategies
	build/bench/bin/kropla_strategies $(STEPS)

bench-spread: packages
	cmake --preset bench
	cmake --build --preset bench --target kropla_spread
	build/bench/bin/kropla_spread $(STEPS)

bench-transfer: packages
	cmake --preset bench
	cmake --build --preset bench --target kropla_transfer_study
	build/bench/bin/kropla_transfer_study

endurance: packages
	cmake --preset bench
	cmake --build --preset bench --target kropla_endurance
	build/bench/bin/kropla_endurance $(STEPS)

validate: packages
	cmake --preset bench
	cmake --build --preset bench --target kropla_validate
	build/bench/bin/kropla_validate

validate-modes: packages
	cmake --preset bench
	cmake --build --preset bench --target kropla
	bench/drop-modes build/bench/bin/kropla build/bench/modes

clean:
	rm -rf build demo flood
