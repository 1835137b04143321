//! Values computed from files once for many runs, on any thread.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Number of values that are kept.
const MOST: usize = 64;

/// A value with what it was computed from. It is locked while it is computed.
type Entry<K, V> = (K, Arc<Mutex<Option<V>>>);

/// Values of a function that takes long, each computed once by the first who asks and shared by all threads. The 64 that
/// are newest are kept. Values that cannot be computed are not kept.
///
/// ```
/// use formats::kept::KeptValues;
///
/// let squares = KeptValues::default();
/// let square = |n: i32| squares.get(&n, || n.checked_mul(n).ok_or("too large"));
/// assert_eq!((square(3), square(3)), (Ok(9), Ok(9)));
/// assert_eq!(squares.get(&3, || Err("is not asked again")), Ok(9));
/// assert_eq!(square(i32::MAX), Err("too large"));
/// ```
#[derive(Debug)]
pub struct KeptValues<K, V> {
    /// In the order in which they were asked for first.
    entries: Mutex<VecDeque<Entry<K, V>>>,
}

impl<K, V> Default for KeptValues<K, V> {
    fn default() -> Self {
        KeptValues {
            entries: Mutex::default(),
        }
    }
}

impl<K: Clone + PartialEq, V: Clone> KeptValues<K, V> {
    /// The value for `key`, which `compute` computes unless it is known.
    ///
    /// # Errors
    /// Those of `compute`.
    pub fn get<E>(&self, key: &K, compute: impl FnOnce() -> Result<V, E>) -> Result<V, E> {
        let entry = self.entry(key);
        let mut value = unpoisoned(&entry);
        if let Some(known) = &*value {
            return Ok(known.clone());
        }
        let made = compute()?;
        Ok(value.insert(made).clone())
    }

    /// The entry of a key, the newest if it is new.
    fn entry(&self, key: &K) -> Arc<Mutex<Option<V>>> {
        let mut entries = unpoisoned(&self.entries);
        if let Some((_, entry)) = entries.iter().find(|(known, _)| known == key) {
            return Arc::clone(entry);
        }
        if entries.len() == MOST {
            entries.pop_front();
        }
        let entry = Arc::default();
        entries.push_back((key.clone(), Arc::clone(&entry)));
        entry
    }
}

/// A panic while a value was computed has left none.
fn unpoisoned<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicUsize, Ordering};

    use super::*;

    #[test]
    fn a_value_is_computed_once_until_it_is_the_oldest_of_many() {
        let (kept, computed) = (KeptValues::default(), AtomicUsize::new(0));
        let ask = |key: usize| {
            let made = kept.get(&key, || {
                computed.fetch_add(1, Ordering::Relaxed);
                Ok::<_, ()>(10 * key)
            });
            assert_eq!(made, Ok(10 * key));
        };
        let count = || computed.load(Ordering::Relaxed);
        (0..MOST).chain(0..MOST).for_each(ask);
        assert_eq!(count(), MOST);
        ask(MOST);
        ask(0);
        assert_eq!(count(), MOST + 2, "the first one had to go");
    }

    #[test]
    fn threads_share_one_computation() {
        let (kept, computed) = (KeptValues::default(), AtomicUsize::new(0));
        std::thread::scope(|scope| {
            for _ in 0..4 {
                scope.spawn(|| {
                    let made = kept.get(&"girder", || {
                        computed.fetch_add(1, Ordering::Relaxed);
                        std::thread::sleep(std::time::Duration::from_millis(5));
                        Ok::<_, ()>(7)
                    });
                    assert_eq!(made, Ok(7));
                });
            }
        });
        assert_eq!(computed.load(Ordering::Relaxed), 1);
    }
}
