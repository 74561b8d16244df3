//! The two servers: Rerun's page, and the data behind it. Both on loopback unless told otherwise.

use crate::Config;
use crate::layout;
use anyhow::Context as _;
use rerun::web_viewer::WebViewerConfig;
use rerun::{MemoryLimit, RecordingStream, RecordingStreamBuilder, ServerOptions};
use std::net::TcpListener;

const WEB_PORT: u16 = 9090;
const DATA_PORT: u16 = 9876;

/// What is logged to, and what keeps the page up.
pub(crate) struct Served {
    pub(crate) recording: RecordingStream,
    #[allow(dead_code, reason = "the page goes when it is dropped")]
    page: Option<Box<dyn std::any::Any>>,
    /// Where to look.
    pub(crate) url: String,
}

pub(crate) fn start(config: &Config) -> anyhow::Result<Served> {
    let builder = RecordingStreamBuilder::new("limn").with_blueprint(layout::blueprint());
    if let Some(path) = &config.save {
        let recording = builder.save(path).with_context(|| format!("writing {path}"))?;
        return Ok(Served { recording, page: None, url: path.clone() });
    }
    let data_port = free_port(&config.bind, config.data_port, DATA_PORT)?;
    let memory_limit = MemoryLimit::from_bytes(config.memory_mib << 20);
    let options = ServerOptions { memory_limit, ..ServerOptions::default() };
    let recording = builder
        .serve_grpc_opts(&config.bind, data_port, options)
        .with_context(|| format!("serving the data of the page on {}:{data_port}", config.bind))?;
    let source = format!("rerun+http://{}:{data_port}/proxy", config.bind);
    if !config.page {
        return Ok(Served { recording, page: None, url: source });
    }
    let web_port = free_port(&config.bind, config.web_port, WEB_PORT)?;
    let page = WebViewerConfig {
        bind_ip: config.bind.clone(),
        web_port: web_port.into(),
        open_browser: false,
        ..WebViewerConfig::default()
    }
    .host_web_viewer()
    .with_context(|| format!("serving the page on {}:{web_port}", config.bind))?;
    let query = source.replace('+', "%2B").replace(':', "%3A").replace('/', "%2F");
    let url = format!("{}/?url={query}", page.server_url());
    Ok(Served { recording, url, page: Some(Box::new(page)) })
}

/// The port that was asked for; or the usual one; or, when that is taken, any.
fn free_port(bind: &str, asked: u16, usual: u16) -> anyhow::Result<u16> {
    if asked != 0 {
        TcpListener::bind((bind, asked))
            .with_context(|| format!("view: port {asked} on {bind} is in use; give another, or 0 for any"))?;
        return Ok(asked);
    }
    if TcpListener::bind((bind, usual)).is_ok() {
        return Ok(usual);
    }
    let listener = TcpListener::bind((bind, 0)).with_context(|| format!("view: no free port on {bind}"))?;
    Ok(listener.local_addr().context("view: which port is free")?.port())
}
