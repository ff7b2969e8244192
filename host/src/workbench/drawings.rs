//! Drawings that were made, by what they are of: who asks while one is made waits for it.

use serde_json::Value;
use std::collections::HashMap;
use std::future::Future;
use std::sync::{Arc, Mutex, PoisonError};
use tokio::sync::OnceCell;

/// Most drawings that are kept.
const MOST: usize = 48;

type Cell = Arc<OnceCell<Arc<Value>>>;

/// Drawings by their keys.
#[derive(Default)]
pub(super) struct Drawings(Mutex<HashMap<String, Cell>>);

impl Drawings {
    /// The drawing of that key, made by `draw` if nobody has made it. A failure is not kept.
    pub(super) async fn get<E>(
        &self,
        key: String,
        draw: impl Future<Output = Result<Value, E>>,
    ) -> Result<Arc<Value>, E> {
        let cell = self.cell(key);
        cell.get_or_try_init(|| async { draw.await.map(Arc::new) })
            .await
            .cloned()
    }

    fn cell(&self, key: String) -> Cell {
        let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if kept.len() >= MOST && !kept.contains_key(&key) {
            kept.clear();
        }
        Arc::clone(kept.entry(key).or_default())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn a_hundred_that_ask_at_once_have_one_drawing_made() {
        let runtime = tokio::runtime::Runtime::new().expect("a runtime");
        let (drawings, made) = (Arc::new(Drawings::default()), Arc::new(AtomicUsize::new(0)));
        runtime.block_on(async {
            let asked: Vec<_> = (0..100)
                .map(|_| {
                    let (drawings, made) = (Arc::clone(&drawings), Arc::clone(&made));
                    tokio::spawn(async move {
                        let draw = async {
                            tokio::task::yield_now().await;
                            made.fetch_add(1, Ordering::Relaxed);
                            Ok::<_, ()>(json!(7))
                        };
                        *drawings.get("one".to_owned(), draw).await.expect("drawn") == json!(7)
                    })
                })
                .collect();
            for asked in asked {
                assert!(asked.await.expect("no panic"));
            }
            let failed = drawings.get("two".to_owned(), async { Err("no") }).await;
            assert_eq!(failed.err(), Some("no"));
            let again = drawings.get("two".to_owned(), async { Ok::<_, &str>(json!(1)) });
            assert_eq!(*again.await.expect("drawn"), json!(1));
        });
        assert_eq!(made.load(Ordering::Relaxed), 1);
    }
}
