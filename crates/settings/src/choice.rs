/// Declares an enum whose values are words: in files of settings, on the command line, in records.
///
/// ```
/// pomona_settings::choices! {
///     /// How tea is made.
///     pub enum Brew {
///         /// Leaves in the pot.
///         Loose = "loose",
///         /// A bag in the cup.
///         Bag = "bag",
///     }
/// }
///
/// assert_eq!(Brew::from_name("bag"), Some(Brew::Bag));
/// assert_eq!(Brew::ALL.map(Brew::name), ["loose", "bag"]);
/// ```
#[macro_export]
macro_rules! choices {
    (
        $(#[doc = $about:literal])+
        $vis:vis enum $name:ident {
            $(
                $(#[doc = $doc:literal])+
                $variant:ident = $word:literal,
            )+
        }
    ) => {
        $(#[doc = $about])+
        #[derive(
            Clone,
            Copy,
            Debug,
            PartialEq,
            Eq,
            Hash,
            $crate::serde::Serialize,
            $crate::serde::Deserialize,
        )]
        #[serde(crate = "pomona_settings::serde")]
        #[non_exhaustive]
        $vis enum $name {
            $(
                $(#[doc = $doc])+
                #[serde(rename = $word)]
                $variant,
            )+
        }

        impl $name {
            /// All of them, in the order in which they are listed to people.
            pub const ALL: [Self; [$($word),+].len()] = [$(Self::$variant),+];

            /// Its word in files and records and on the command line.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)+
                }
            }

            /// The one with this word.
            pub fn from_name(name: &str) -> Option<Self> {
                Self::ALL.into_iter().find(|choice| choice.name() == name)
            }
        }

        impl $crate::Value for $name {
            const KIND: $crate::Kind = $crate::Kind::Choice(&[
                $($crate::Choice { name: $word, docs: &[$($doc),+] },)+
            ]);

            fn to_toml(&self) -> Option<$crate::toml::Value> {
                Some(self.name().into())
            }
        }
    };
}
