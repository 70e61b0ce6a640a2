// Pictures of the toolchain's files.
#include "lfdtools/cli/program.hpp"
#include "lfdtools/plot/picture.hpp"

using namespace lfd;

int main(int argc, char** argv) {
  using plot::PictureKind;
  plot::PictureOptions options;
  std::vector<std::string> planes;
  cli::Program program("skill-plot", "Draw the toolchain's files as SVG; the picture follows from what they hold.");
  program.reads("CSV or JSON files of the toolchain").uses_columns();
  program.choice("--kind", options.kind,
                 {{"auto", PictureKind::automatic},
                  {"motions", PictureKind::motions},
                  {"planes", PictureKind::planes},
                  {"time", PictureKind::time},
                  {"weights", PictureKind::weights},
                  {"errors", PictureKind::errors},
                  {"reliability", PictureKind::reliability}},
                 "the picture");
  program.words("--planes", planes, "plane views, such as x-y,y-z (default: x-y,y-z and without obstacle x-z)");
  program.text("--title", options.title, "words above the figure");
  program.check([&] { options.planes = plot::planes_of(planes); });
  program.topic("Pictures", {{"motions", "demonstrations, references, motions, goals: planes, and against time"},
                             {"planes", "the same in planes alone; with obstacles of a scene or an experiment"},
                             {"time", "any signals against time; mixture components; bands from columns sd_"},
                             {"weights", "skill-generate --weights, among the rows of primitives or a skill"},
                             {"errors", "bars of skill-validate's table, in mm"},
                             {"reliability", "observed against nominal shares of bands"}});
  program.example("skill-plot demos.csv reference.csv goals.csv -o fig3.svg", "demonstrations and their references");
  program.example("skill-plot weights.csv dmp.json -o fig4.svg", "predicted weights among those of the training");
  program.example("skill-plot motions.csv reference.csv -o fig5.svg", "motions among references");
  program.example("skill-plot motions.csv demos.csv scene.json -o fig8.svg", "planes with the obstacle");
  program.example("skill-validate demos.csv | skill-plot -o errors.svg", "methods compared");
  return program.run(argc, argv, [&](cli::Run& run) {
    const plot::Material material = plot::read_material(
        run.open(), run.messages(),
        {.columns = run.options().columns, .renumber = run.options().renumber, .json = run.json_options()});
    run.output().write(plot::draw(material, options, run.messages()));
  });
}
