// SPDX-License-Identifier: Apache-2.0
/** The page begins here. */
import { Actions } from "./panels/actions";
import { makeBar } from "./panels/bar";
import { caseMeasuresPanel } from "./panels/case_measures_panel";
import { displayPanel } from "./panels/display_panel";
import { findPanel } from "./panels/find_panel";
import { Flight } from "./scene/flight";
import { Frame } from "./frame";
import { Hand } from "./tools/hand";
import { listenToKeys } from "./keys";
import { labelPanel } from "./panels/label_panel";
import { deviationLegend, surfaceLegend } from "./panels/legend";
import { libraryPanel } from "./panels/library_panel";
import { Loader } from "./updates/loader";
import { LumenCase } from "./lumen_case";
import { keepView } from "./model/kept_view";
import { LocalModel } from "./scene/local_model";
import { MeshLayer } from "./scene/mesh_layer";
import { measurePanel } from "./panels/measure_panel";
import { newStore, type App } from "./model/model";
import { motionBar } from "./panels/motion_bar";
import { panelEdge } from "./panels/panel_width";
import { Performer } from "./model/performer";
import { mayChange, Posing } from "./model/posing";
import { offerUnsaved } from "./panels/recover";
import { ProbeLine } from "./panels/probe_line";
import { listenToScene } from "./tools/scene_input";
import { assumptionsPanel, oneSourcePanel } from "./panels/one_source";
import { SceneView } from "./scene/scene_view";
import { offerSeries } from "./panels/series_dialog";
import { makeShell, toast, type Shell } from "./panels/shell";
import { listenToSlice } from "./tools/slice_input";
import { kSliceNames } from "./model/slice_frame";
import { SliceView } from "./slices/slice_view";
import { Refused, type Source } from "./net/source";
import { EmbeddedSource } from "./net/source_embedded";
import { ServerSource } from "./net/source_server";
import { WorkerSource } from "./net/source_worker";
import { Stage } from "./drawing/stage";
import { Strip } from "./panels/strip";
import { Tools } from "./tools/tools";
import { TreePanel } from "./panels/tree_panel";
import { errorText, h } from "./base/ui";
import { applyLayout, Watcher } from "./updates/watcher";
import { WorkList } from "./panels/work_list";
import { workPanel } from "./panels/work_panel";

function makeApp(source: Source, shell: Shell): App {
  const store = newStore(),
    performer = new Performer(store, source);
  const app: App = {
    store,
    source,
    stage: new Stage(shell.canvas),
    inform: (text, severity) => toast(shell, text, severity),
    perform: async operation => {
      if (!mayChange(app, operation)) return false;
      try {
        await performer.perform(operation);
        return true;
      } catch (error) {
        app.inform(
          error instanceof Refused ? error.message : `The operation failed: ${errorText(error)}`,
          "error",
        );
        return false;
      }
    },
  };
  return app;
}

async function start(root: HTMLElement): Promise<void> {
  const frame = Frame.find(),
    source = (await frame?.source()) ?? EmbeddedSource.find() ?? WorkerSource.find() ?? new ServerSource();
  const state = source.state(); // the request is on its way while the graphics start
  const shell = makeShell(root);
  const app = makeApp(source, shell);
  const slices = kSliceNames.map(name => new SliceView(name, shell[name], app)),
    scene = new SceneView(shell.scene, app);
  for (const view of [...slices, scene]) app.stage.add(view);
  new Posing(app);
  shell.scene.append(motionBar(app));
  const hand = new Hand(app);
  const flight = new Flight(app, scene);
  const actions = new Actions(app, scene, slices, flight),
    work = new WorkList(app);
  offerUnsaved(app);
  offerSeries(app);
  if (frame === null) keepView(app);
  else frame.applyView(app.store);
  const tools = new Tools(app, hand, flight);
  for (const slice of slices) listenToSlice(slice, app, tools);
  listenToScene(scene, app, tools);
  makeBar(shell.bar, app, actions);
  new TreePanel(shell.left, app);
  shell.left.append(panelEdge(shell.left, () => app.stage.invalidate()));
  shell.right.append(
    ...oneSourcePanel(app),
    ...assumptionsPanel(app),
    ...libraryPanel(app),
    ...labelPanel(app),
    ...findPanel(app),
    ...workPanel(app, hand, work),
    ...displayPanel(app, actions),
    new MeshLayer(app, scene).panel,
    ...measurePanel(app, actions, hand),
    ...caseMeasuresPanel(app),
  );
  new Strip(shell.strip, app, actions, flight);
  new ProbeLine(shell.probe, app, tools);
  new LocalModel(app, scene);
  surfaceLegend(shell.legend, app);
  deviationLegend(shell.deviations, app);
  listenToKeys(app, actions, hand, work);
  applyLayout(app, shell);
  const loader = new Loader(app, slices, scene),
    watcher = new Watcher(app, shell, loader, actions);
  await watcher.begin(state);
  frame?.ready(app.store);
}

/** The whole page is one of these elements: without `src` it shows what the document embeds, or what the server holds. */
class PageCase extends LumenCase {
  protected override show(): void {
    if (this.hasAttribute("src")) super.show();
    else if (this.childElementCount === 0) start(this).catch((error: unknown) => this.fail(error));
  }
  private fail(error: unknown): void {
    const text = errorText(error);
    this.append(
      h("div", { class: "fatal", role: "alert" }, h("h1", {}, "The viewer cannot start"), h("p", {}, text)),
    );
    Frame.find()?.fail(text);
  }
}
customElements.define("lumen-case", PageCase);
