# The commands of README.md. Everything real lives in CMake; this file installs what is missing and calls it.
BUILD ?= build
JOBS  ?= $(shell nproc)
SCENE ?= scenes/snow_cube.toml
FUZZ_SECONDS ?= 600

.PHONY: all demo test test-clients verify build sanitize sanitize-modules bench gallery fuzz format tidy dependencies clean

all: build

demo: build ## run the main job: mesh -> snow -> frames, pictures and a film
	$(BUILD)/firn run $(SCENE) --force

test: build ## build everything and pass the tests
	cmake --build $(BUILD) --parallel $(JOBS) --target firn_tests
	ctest --test-dir $(BUILD) --output-on-failure --no-tests=error --parallel $(JOBS) -LE clients

build: dependencies ## configure and build the library and the command line tool
	cmake --preset release -B $(BUILD)
	cmake --build $(BUILD) --parallel $(JOBS)

test-clients: dependencies ## open what Firn writes in ParaView, Blender, OpenUSD and others; installs them (docs/clients.md)
	@tools/install_dependencies.sh clients
	cmake --preset release -B $(BUILD)
	cmake --build $(BUILD) --parallel $(JOBS) --target firn
	@tools/make_usd_python.sh $(BUILD)/usd-python || echo "firn: PyPI does not give OpenUSD; its check is skipped" >&2
	FIRN_REQUIRE_CLIENTS="readers paraview blender" ctest --test-dir $(BUILD) --output-on-failure --no-tests=error -L clients

sanitize: dependencies ## the tests under AddressSanitizer and UndefinedBehaviorSanitizer, but for the long ones
	cmake --preset sanitize -B $(BUILD)-sanitize
	cmake --build $(BUILD)-sanitize --parallel $(JOBS) --target firn_tests
	ctest --test-dir $(BUILD)-sanitize --output-on-failure --no-tests=error --parallel $(JOBS) -L 'module|program'

sanitize-modules: dependencies ## the same without the tests that drive the program and its window: half of the time
	cmake --preset sanitize -B $(BUILD)-sanitize
	cmake --build $(BUILD)-sanitize --parallel $(JOBS) --target firn_module_tests
	ctest --test-dir $(BUILD)-sanitize --output-on-failure --no-tests=error --parallel $(JOBS) -L module

verify: build ## the problems of docs/verification-scenes.md at full resolution; rewrites its tables
	cmake --build $(BUILD) --parallel $(JOBS) --target firn_verify
	$(BUILD)/tests/verification_scenes/firn_verify

bench: build ## particle-steps per second, bytes per particle and the time of each verb of the step
	$(BUILD)/firn bench

gallery: build ## run every scene of scenes/gallery; writes docs/gallery.md and its pictures
	tools/gallery.py --firn $(BUILD)/firn

fuzz: ## search for inputs that break a reader: FUZZ_SECONDS for each target of tests/fuzz, with libFuzzer (docs/fuzzing.md)
	@tools/install_dependencies.sh fuzz
	cmake --preset fuzz
	cmake --build build-fuzz --parallel $(JOBS)
	tools/fuzz.py --seconds $(FUZZ_SECONDS)

format: ## rewrite the sources in the project's layout
	git ls-files 'src/*.h' 'src/*.cc' 'tests/*.h' 'tests/*.cc' | xargs clang-format -i

tidy: build ## naming and bug-prone patterns
	git ls-files 'src/*.cc' | xargs -P $(JOBS) -n 4 clang-tidy --quiet -p $(BUILD)

dependencies: ## install the Debian packages that are missing
	@tools/install_dependencies.sh

clean:
	rm -rf $(BUILD) $(BUILD)-sanitize build-fuzz
