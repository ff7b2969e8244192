//! Listening on the loopback address, until the user has enough.

use super::device::Device;
use super::guard;
use super::job::{self, ALONE};
use super::loaded::Loaded;
use super::lock::Lock;
use super::opened::Role;
use super::recordings::Recordings;
use super::routes::routes;
use super::session_file::SessionFile;
use super::state::Bench;
use super::work;
use crate::error::Error;
use axum::Router;
use hyper::server::conn::http1;
use hyper_util::rt::{TokioIo, TokioTimer};
use hyper_util::service::TowerToHyperService;
use std::io::{self, ErrorKind};
use std::net::{Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};
use tokio::net::TcpListener;
use tokio::runtime::Runtime;

/// How often it is looked whether the user has enough, or nobody watches any more.
const LOOK: Duration = Duration::from_millis(100);

/// Longest time until what is asked for is said.
const HEADERS: Duration = Duration::from_secs(10);

/// What lies on the bench when it is opened.
pub enum Opening {
    /// Nothing.
    Empty,
    /// A recording, and perhaps one that is never fitted.
    Recording(Box<Loaded>, Option<Box<Loaded>>),
    /// A session that was saved.
    Session(Box<SessionFile>),
    /// Logs of which it must be said what their columns are: fitted ones, and others that are held out.
    Unknown(Vec<PathBuf>, Vec<PathBuf>),
}

/// A workbench that listens.
pub struct Server {
    runtime: Runtime,
    listener: TcpListener,
    bench: Arc<Bench>,
    secret: String,
    address: SocketAddr,
    /// Of the session's file.
    _lock: Option<Lock>,
}

impl Server {
    /// Lays `opening` on the bench and listens on `port`, or on any free one for zero. The bench is kept in `file` after
    /// every change; a device that is connected can be driven from the page.
    ///
    /// # Errors
    /// A recording that cannot be fitted, a port that is taken, a system without randomness.
    pub fn open(
        opening: Opening,
        port: u16,
        file: Option<PathBuf>,
        device: Option<Device>,
    ) -> Result<Self, Error> {
        let failed = |what: &str, error: &dyn std::fmt::Display| {
            Error::Failed(format!("the workbench cannot {what}: {error}"))
        };
        let lock = file.as_deref().map(Lock::take).transpose()?;
        let bench = Bench::new(file, device);
        match opening {
            Opening::Empty => {}
            Opening::Recording(fitted, held_out) => {
                let recordings = Recordings::new(Arc::from(fitted), held_out.map(Arc::from));
                bench.change(|state| state.begin(recordings));
            }
            Opening::Session(session) => bench.change(|state| session.lay(state))?,
            Opening::Unknown(fitted, held_out) => {
                for (k, path) in fitted.iter().enumerate() {
                    let role = if k == 0 { Role::Fitted } else { Role::Beside };
                    bench.dropped.name(path, role);
                }
                for path in &held_out {
                    bench.dropped.name(path, Role::HeldOut);
                }
            }
        }
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(2)
            .enable_all()
            .build()
            .map_err(|error| failed("start", &error))?;
        let secret = guard::secret().map_err(|error| failed("draw a secret", &error))?;
        let listener = runtime
            .block_on(TcpListener::bind((Ipv4Addr::LOCALHOST, port)))
            .map_err(|error| failed(&format!("listen on port {port} of 127.0.0.1"), &error))?;
        let address = listener
            .local_addr()
            .map_err(|error| failed("listen", &error))?;
        // Also where a session ended before its first fit did.
        let unfitted = {
            let state = bench.state();
            state.recordings.is_some() && state.models.is_empty()
        };
        if unfitted {
            job::start(&bench, "fit", |bench| work::fit(bench, &[], "lm"))?;
        }
        Ok(Server {
            runtime,
            listener,
            bench,
            secret,
            address,
            _lock: lock,
        })
    }

    /// The address of the page. Whoever has it may use the bench.
    pub fn url(&self) -> String {
        format!("http://{}/{}/", self.address, self.secret)
    }

    /// Serves until `stop`.
    ///
    /// # Errors
    /// Where the system takes the port away.
    pub fn serve(self, stop: &AtomicBool) -> Result<(), Error> {
        let bench = Arc::clone(&self.bench);
        let app = routes(Arc::clone(&bench), &self.secret);
        let served = self.runtime.block_on(async {
            tokio::select! {
                served = accept(&self.listener, &app) => served,
                () = until(stop, &bench) => Ok(()),
            }
        });
        bench.job.stop();
        self.runtime.shutdown_timeout(Duration::from_secs(2));
        served.map_err(|error| Error::Failed(format!("the workbench broke off: {error}")))
    }
}

/// Answers every connection; one on which nobody asks for long is closed.
async fn accept(listener: &TcpListener, app: &Router) -> io::Result<()> {
    loop {
        let (stream, _) = match listener.accept().await {
            Ok(accepted) => accepted,
            // Of one connection, which is gone.
            Err(error) if is_of_a_connection(&error) => continue,
            Err(error) => return Err(error),
        };
        let service = TowerToHyperService::new(app.clone());
        tokio::spawn(async move {
            let mut http = http1::Builder::new();
            http.timer(TokioTimer::new()).header_read_timeout(HEADERS);
            // A browser that goes away in the middle is no fault.
            let _ = http.serve_connection(TokioIo::new(stream), service).await;
        });
    }
}

fn is_of_a_connection(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::ConnectionRefused | ErrorKind::ConnectionAborted | ErrorKind::ConnectionReset
    )
}

/// Waits for `stop`; meanwhile stops work that nobody watches any more.
async fn until(stop: &AtomicBool, bench: &Bench) {
    let mut seen = Instant::now();
    // The first page may take its time to be opened.
    let mut was_watched = false;
    while !stop.load(Ordering::Relaxed) {
        tokio::time::sleep(LOOK).await;
        if bench.job.watched() {
            seen = Instant::now();
            was_watched = true;
        } else if was_watched && bench.job.running().is_some() && seen.elapsed() > ALONE {
            bench.job.stop();
        }
    }
}
