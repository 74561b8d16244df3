//! Launch files: what they say, where they say it, and what is refused.

#![allow(clippy::unwrap_used, reason = "a helper that cannot go on has failed its test")]

use limn::kind::{Inputs, Kind};
use limn::plan::Plan;
use serde::{Deserialize, Serialize};
use std::path::Path;
use tempfile::TempDir;

#[derive(Serialize, Deserialize, Default)]
#[serde(default, deny_unknown_fields)]
struct Config {
    scene: String,
    rig: String,
    gain: f64,
    limit: Option<u32>,
    fine: Fine,
}

#[derive(Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct Fine {
    width_px: f64,
}

impl Default for Fine {
    fn default() -> Self {
        Self { width_px: 2.5 }
    }
}

fn check(config: &Config) -> Result<(), String> {
    if config.gain < 0.0 { Err(format!("gain = {}: not below 0", config.gain)) } else { Ok(()) }
}

const EYE: Kind = Kind {
    name: "eye",
    about: "looks",
    source: true,
    paces: false,
    required: true,
    inputs: &[],
    paths: &["scene", "rig"],
    takes: |_| vec!["run/phase".to_owned()],
    gives: |inputs: &Inputs| vec![format!("camera/{}/frame", inputs.instance)],
    takes_more: |_, _| Vec::new(),
    gives_more: |_, _| Vec::new(),
    defaults: limn::kind::defaults::<Config>,
    check: |config| limn::kind::check(config, check),
    run: |_| Ok(()),
};

const BRAIN: Kind = Kind {
    name: "brain",
    about: "thinks",
    source: false,
    paces: true,
    inputs: &["camera"],
    takes: |inputs: &Inputs| vec![format!("camera/{}/frame", inputs.of("camera"))],
    gives: |_| vec!["model/mesh".to_owned()],
    ..EYE
};

const KINDS: &[Kind] = &[EYE, BRAIN];

struct Files(TempDir);

impl Files {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        Self(folder)
    }

    fn path(&self, name: &str) -> std::path::PathBuf {
        self.0.path().join(name)
    }

    fn load(&self, sets: &[&str]) -> Result<Plan, String> {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        let shown = |error: anyhow::Error| format!("{error:#}").replace(&format!("{}/", self.0.path().display()), "");
        Plan::load(&self.path("rig.toml"), &sets, KINDS).map_err(shown)
    }
}

fn refusal(text: &str, sets: &[&str]) -> String {
    Files::new(&[("rig.toml", text)]).load(sets).expect_err("refused")
}

const EYE_AND_BRAIN: &str = "[nodes.eye]\n[nodes.brain]\n";

#[test]
fn the_last_word_wins_and_every_value_knows_where_it_was_said() {
    let files = Files::new(&[
        ("rig.toml", "include = 'pipeline.toml'\n[nodes.eye]\nconfig.scene = 'cow.toml'\n"),
        ("pipeline.toml", "[nodes.brain]\n[nodes.eye]\nkind = 'eye'\nconfig.gain = 1\nconfig.scene = 'cup.toml'\n"),
    ]);
    let plan = files.load(&["eye.gain=3", "run.pace=fast", "eye.limit=7"]).unwrap();
    let eye = plan.node("eye").unwrap();
    assert_eq!(eye.config["gain"], 3);
    assert_eq!(eye.config["limit"], 7);
    assert_eq!(eye.config["fine"]["width_px"], 2.5);
    assert_eq!(eye.config["scene"], files.path("cow.toml").to_str().unwrap(), "beside the file that says it");
    let text = plan.to_toml().replace(&format!("{}/", files.0.path().display()), "");
    for line in [
        "pace = \"fast\" # --set run.pace=fast",
        "width_px = 2.5 # default",
        "kind = \"eye\" # pipeline.toml:3",
        "gain = 3 # --set eye.gain=3",
        "scene = \"cow.toml\" # rig.toml:3",
    ] {
        let squeezed: String =
            text.lines().map(|l| l.split_whitespace().collect::<Vec<_>>().join(" ") + "\n").collect();
        assert!(squeezed.contains(line), "{line} is not in\n{text}");
    }
}

#[test]
fn the_printed_configuration_is_a_launch_file_that_means_the_same() {
    let files = Files::new(&[("rig.toml", EYE_AND_BRAIN)]);
    let plan = files.load(&["eye.gain=3"]).unwrap();
    std::fs::write(files.path("rig.toml"), plan.to_toml()).unwrap();
    let again = files.load(&[]).unwrap();
    assert_eq!(again.nodes, plan.nodes);
}

#[test]
fn unknown_words_are_refused_where_they_stand_naming_the_nearest() {
    let cases = [
        ("[node.eye]\n", "rig.toml:1: unknown key \"node\", did you mean \"nodes\"?"),
        ("[nodes.eye]\nsorce = true\n", "rig.toml:2: unknown key \"sorce\" in [nodes.eye], did you mean \"source\"?"),
        (
            "[nodes.eye]\n[nodes.eye.config]\ngian = 1\n",
            "rig.toml:3: unknown key \"gian\" in [nodes.eye.config], did you mean \"gain\"?",
        ),
        ("[nodes.eye]\nconfig.fine.width = 1\n", "rig.toml:2: unknown key \"width\" in [nodes.eye.config.fine]"),
        (
            "[nodes.ear]\nkind = 'brian'\n",
            "rig.toml:2: nodes.ear: this limn has no node of kind \"brian\", did you mean \"brain\"?",
        ),
        (
            "[nodes.brain]\ninputs.kamera = 'head'\n",
            "rig.toml:2: brain has no input \"kamera\", did you mean \"camera\"?",
        ),
        ("[run]\nwindow = 3\n[nodes.eye]\n", "rig.toml:2: unknown key \"window\" in [run]"),
        ("[nodes.eye]\nmachine = 'attic'\n", "rig.toml:2: nodes.eye: there is no [machines.attic]"),
        ("[nodes.eye]\nrestart = 'allways'\n", "rig.toml:2: nodes.eye.restart = \"allways\""),
    ];
    for (text, wanted) in cases {
        let got = refusal(text, &[]);
        assert!(got.contains(wanted), "{text:?} was refused with {got:?}");
    }
    assert!(
        refusal(EYE_AND_BRAIN, &["eyes.gain=1"])
            .contains("there is no node or section \"eyes\", did you mean \"eye\"?")
    );
    assert!(refusal(EYE_AND_BRAIN, &["eye.gian=1"]).contains("--set eye.gian=1: unknown key \"gian\""));
    assert!(refusal(EYE_AND_BRAIN, &["gain"]).contains("say node.key=value"));
    assert!(refusal(EYE_AND_BRAIN, &["eye..gain=1"]).contains("is no node.key"));
}

#[test]
fn wrong_values_are_refused_where_they_stand() {
    let cases = [
        ("[nodes.eye]\nconfig.gain = -1\n", "rig.toml:2: nodes.eye.config: gain = -1: not below 0"),
        ("[nodes.eye]\nconfig.gain = 'much'\n", "nodes.eye.config: invalid type"),
        ("[nodes.eye]\nsource = 1\n", "rig.toml:2: nodes.eye.source takes true or false"),
        ("[run]\nready_s = -1\n[nodes.eye]\n", "rig.toml:2: run.ready_s takes seconds"),
        ("nodes = 3\n", "nothing to start"),
        ("", "nothing to start"),
        ("[nodes.eye\n", "rig.toml:1:"),
        ("[nodes.eye]\ninstance = 'a/b'\n", "cannot name an instance"),
        ("[nodes.run]\nkind = 'eye'\n", "\"run\" cannot name a node"),
        ("[nodes.a]\nkind = 'eye'\n[nodes.b]\nkind = 'eye'\n", "are both eye/head: give one another instance"),
        ("[rig]\nfile = 'gone.toml'\n[nodes.eye]\n", "rig.toml:2: rig.file: there is no gone.toml"),
        ("[machines.m]\nssh = '-oProxyCommand=x'\n[nodes.eye]\n", "say user@host"),
        ("include = 7\n", "include takes a path or a list of paths"),
        ("include = 'gone.toml'\n", "cannot read the launch file gone.toml"),
        ("include = 'rig.toml'\n", "includes itself"),
    ];
    for (text, wanted) in cases {
        let got = refusal(text, &[]);
        assert!(got.contains(wanted), "{text:?} was refused with {got:?}");
    }
}

#[test]
fn nothing_beyond_loopback_without_certificates() {
    let got = refusal("[bus]\nendpoint = '0.0.0.0:7447'\n[nodes.eye]\n", &[]);
    assert!(got.starts_with("rig.toml:2:") && got.contains("not loopback"), "{got}");
    let got = refusal("[bus]\nendpoint = '0.0.0.0:7447'\ntls.root_ca = 'gone.pem'\n[nodes.eye]\n", &[]);
    assert!(got.contains("rig.toml:3: bus.tls.root_ca: there is no gone.pem"), "{got}");
    let files = Files::new(&[
        (
            "rig.toml",
            "[bus]\nendpoint='0.0.0.0:7447'\n[bus.tls]\nroot_ca='a.pem'\ncertificate='a.pem'\nprivate_key='a.pem'\n[nodes.eye]\n",
        ),
        ("a.pem", ""),
    ]);
    let tls = files.load(&[]).unwrap().bus.tls.unwrap();
    assert_eq!(tls.root_ca, files.path("a.pem").to_str().unwrap());
}

#[test]
fn a_node_that_is_not_built_in_is_left_out_when_nobody_requires_it() {
    let files = Files::new(&[("rig.toml", "[nodes.eye]\n[nodes.view]\nrequired = false\n")]);
    let plan = files.load(&[]).unwrap();
    assert!(plan.node("view").is_none());
    assert!(plan.warnings[0].contains("left out"), "{:?}", plan.warnings);
    assert!(files.load(&["nodes.eye.enabled=false"]).unwrap().nodes.is_empty());
}

#[test]
fn a_node_with_a_rig_takes_that_of_the_launch_file() {
    let files = Files::new(&[("rig.toml", "[rig]\nfile = 'fine.toml'\n[nodes.eye]\n"), ("fine.toml", "")]);
    let plan = files.load(&[]).unwrap();
    assert_eq!(plan.node("eye").unwrap().config["rig"], files.path("fine.toml").to_str().unwrap());
}

#[test]
fn the_graph_says_who_feeds_whom() {
    let files = Files::new(&[("rig.toml", EYE_AND_BRAIN)]);
    let plan = files.load(&[]).unwrap();
    let text = limn::graph::text(&plan);
    assert!(
        text.contains(
            "eye (eye/head, a source)\n    camera/head/frame -> brain\nbrain (brain/head)\n    model/mesh -> nobody"
        ),
        "{text}"
    );
    assert!(limn::graph::dot(&plan).contains("\"eye\" -> \"brain\" [label = \"camera/head/frame\"]"));
    let eye = plan.node("eye").unwrap();
    assert_eq!(limn::graph::consumers(&plan.nodes, eye), ["brain/head"]);
    assert!(plan.warnings.is_empty(), "{:?}", plan.warnings);
    let deaf = Files::new(&[("rig.toml", "[nodes.eye]\ninstance = 'left'\n[nodes.brain]\n")]).load(&[]).unwrap();
    assert_eq!(deaf.warnings, ["brain takes camera/head/frame, which no node of this rig gives"]);
}

#[test]
fn keys_match_as_on_the_bus() {
    use limn::graph::matches;
    assert!(matches("camera/*/frame", "camera/head/frame"));
    assert!(!matches("camera/*/frame", "camera/a/b/frame"));
    assert!(matches("**", "a/b/c") && matches("a/**", "a") && matches("**/c", "a/b/c"));
    assert!(!matches("**", "@health/x") && !matches("*", "@health"), "housekeeping is not seen");
    assert!(matches("@health/**", "@health/stripe/head"));
}

#[test]
fn missing_files_are_named() {
    let error = Plan::load(Path::new("no/such.toml"), &[], KINDS).unwrap_err();
    assert!(format!("{error:#}").contains("no/such.toml"));
}

mod hostile {
    use super::KINDS;
    use limn::plan::Plan;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(200))]
        #[test]
        fn no_text_makes_the_reader_panic(text in "(\\[|\\]|=|'|\"|\\.|nodes|eye|kind|include|config|run|[a-z0-9 \n]){0,40}", set in ".{0,20}") {
            let folder = tempfile::tempdir().unwrap();
            let file = folder.path().join("rig.toml");
            std::fs::write(&file, text).unwrap();
            let _ = Plan::load(&file, &[set], KINDS);
        }
    }
}
